//! Which joint each column of a table of the G1 is, where names may be missing.
//!
//! Separate because 23 columns are two robots: the one with 23 joints (waist yaw, arms of five), and the
//! one with 29 whose wrists are fixed (waist yaw, roll and pitch, arms of four), which ASAP, PBHC and PHC
//! train. Nothing in a table of numbers says which, but a wrong reading has arms that are no pair.

use super::file::File;
use super::file::array::Array;
use super::joints::{self, SDK_29};
use super::{Row, lean};
use crate::error::MotionError;
use g1::{JOINT_TABLE, JOINTS};
use retarget::signal::median;

/// An order of 23 columns after the legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Waist yaw, then arms of five: our own.
    Wrists,
    /// Waist yaw, roll and pitch, then arms of four: ASAP's.
    Waist,
}

/// Limit of the waist's roll and pitch, rad: `g1_29dof_anneal_23dof.yaml` of LeCAR-Lab/ASAP at 91df82c9.
const WAIST_LIMIT: f64 = 0.52;
/// An angle so far beyond a joint's limit is another joint's, rad.
const BEYOND: f64 = 0.1;
/// Arms whose medians differ by more between the sides are no pair, rad; and one order must be better than
/// the other by the second. Of the 59 motions that come with ASAP and PBHC, without all that names their
/// order, 52 are read in theirs and 7 are refused; written in the robot's own order, all 59 are read so.
const PAIR: f64 = 0.25;
const CLEAR: f64 = 0.15;
/// Where all columns from [`ARMS`] on are so near to zero, rad, the orders say the same.
const NOTHING: f64 = 0.02;
const ARMS: usize = 13;

impl Order {
    const BOTH: [Self; 2] = [Self::Wrists, Self::Waist];

    /// The joints in this order.
    pub(super) fn names(self) -> [&'static str; JOINTS] {
        match self {
            Self::Wrists => joints::ours(),
            Self::Waist => {
                let mut names = SDK_29.into_iter().filter(|name| !name.contains("wrist"));
                std::array::from_fn(|_| names.next().expect("29 joints without six are 23"))
            }
        }
    }

    /// The columns in this order and their names, wrists and all.
    pub(super) fn whole(self, angles: &Array, decisions: &mut Vec<String>) -> (Array, Vec<String>) {
        whole(angles, self.names().map(String::from).to_vec(), decisions)
    }

    pub(super) fn told(self) -> &'static str {
        match self {
            Self::Wrists => "legs, waist yaw, arms of 5 (the SDK's order)",
            Self::Waist => "legs, waist yaw, roll and pitch, arms of 4 (ASAP's order)",
        }
    }

    /// How far the angles are beyond the limits that this order gives them, rad; not more than 0 if they
    /// are within.
    fn beyond(self, angles: &Array) -> f64 {
        let mut worst = f64::NEG_INFINITY;
        for (column, name) in self.names().into_iter().enumerate() {
            let ours = joints::ours().iter().position(|ours| *ours == name);
            let (lower, upper) = ours.map_or((-WAIST_LIMIT, WAIST_LIMIT), |j| {
                (JOINT_TABLE[j].lower, JOINT_TABLE[j].upper)
            });
            for frame in 0..angles.frames() {
                let angle = angles.frame(frame)[column];
                worst = worst.max(lower - angle).max(angle - upper);
            }
        }
        worst
    }

    /// How far the arms are from being a pair: the mean over their joints of the difference between the
    /// left median and the mirrored right one, rad.
    fn asymmetry(self, medians: &[f64]) -> f64 {
        let names = self.names();
        let column = |name: &str| names.iter().position(|n| *n == name);
        let (mut sum, mut count) = (0.0, 0.0);
        for name in &names[ARMS..] {
            let Some(other) = name
                .strip_prefix("left_")
                .map(|stem| format!("right_{stem}"))
            else {
                continue;
            };
            let (Some(left), Some(right)) = (column(name), column(&other)) else {
                continue;
            };
            // Only turns about the axis across are alike on both sides.
            let sign = if axis(name) == 1 { 1.0 } else { -1.0 };
            sum += (medians[left] - sign * medians[right]).abs();
            count += 1.0;
        }
        sum / f64::max(count, 1.0)
    }
}

/// The axis that a joint of the G1 turns about when all are at zero: 0 for x, 1 for y, 2 for z.
pub(super) fn axis(name: &str) -> usize {
    match name.rsplit('_').next() {
        Some("roll") => 0,
        Some("yaw") => 2,
        _ => 1,
    }
}

/// Which order the motion itself speaks for, and how; or what speaks for neither.
fn plausible(angles: &Array) -> Result<(Order, String), String> {
    if (0..angles.frames()).all(|i| angles.frame(i)[ARMS..].iter().all(|a| a.abs() < NOTHING)) {
        return Ok((
            Order::Wrists,
            "arms at zero within 1°, the same in either order".into(),
        ));
    }
    let [own, other] = Order::BOTH.map(|order| order.beyond(angles));
    for (order, within, outside) in [(Order::Wrists, own, other), (Order::Waist, other, own)] {
        if within <= BEYOND && outside > BEYOND {
            let told =
                format!("in the other order joints are {outside:.2} rad beyond their limits");
            return Ok((order, told));
        }
    }
    let medians: Vec<f64> = (0..JOINTS)
        .map(|column| {
            let mut series: Vec<f64> = (0..angles.frames())
                .map(|i| angles.frame(i)[column])
                .collect();
            median(&mut series)
        })
        .collect();
    let [own, other] = Order::BOTH.map(|order| order.asymmetry(&medians));
    let told = format!(
        "arms differ between the sides by {own:.2} rad with wrists and by {other:.2} rad with waist roll \
         and pitch"
    );
    let (order, better, worse) = if own <= other {
        (Order::Wrists, own, other)
    } else {
        (Order::Waist, other, own)
    };
    if better <= PAIR && worse - better >= CLEAR {
        return Ok((order, told));
    }
    Err(told)
}

/// What speaks for an order beside the numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Said {
    /// Nothing: the motion must tell, or the file is refused.
    Nothing,
    /// Files of this kind have it; the motion may tell otherwise.
    Usual(Order),
    /// The user, by naming the format; limits may contradict.
    User(Order),
}

/// The columns of a G1's joints and their names: 29 in the SDK's order, or 23 in the order that fits.
/// Joints of ours that the file has not are added, at zero.
///
/// # Errors
/// Another count of columns, or 23 that could be either order.
pub(super) fn of_g1(
    file: &File<'_>,
    (angles, name): (&Array, &str),
    said: Said,
    decisions: &mut Vec<String>,
) -> Result<(Array, Vec<String>), MotionError> {
    angles.check(
        file,
        name,
        &[JOINTS, SDK_29.len()],
        super::file::array::ANGLES,
    )?;
    if angles.width() == SDK_29.len() {
        decisions.push("29 joints in the SDK's order".into());
        return Ok((angles.clone(), SDK_29.map(String::from).to_vec()));
    }
    let order = match (said, plausible(angles)) {
        (Said::User(order), told) => {
            let limits = order.beyond(angles);
            if limits > BEYOND && told.is_ok_and(|(other, _)| other != order) {
                return Err(file.unusable(
                    &format!(
                        "has joints {limits:.2} rad beyond their limits if {name} is {}",
                        order.told()
                    ),
                    "leave out --format, or name the joints",
                ));
            }
            decisions.push(format!("{}, as --format says", order.told()));
            order
        }
        (_, Ok((order, told))) => {
            decisions.push(format!("{}: {told}", order.told()));
            order
        }
        (Said::Usual(order), Err(told)) => {
            decisions.push(format!("{}, as usual in this format: {told}", order.told()));
            order
        }
        (Said::Nothing, Err(told)) => {
            return Err(file.unusable(
                &format!("has 23 joints in {name} that could be in two orders ({told})"),
                "say which: --format phc for waist yaw, roll and pitch and arms of 4 joints, --format gmr \
                 for waist yaw and arms of 5; or add joint_names",
            ));
        }
    };
    Ok(order.whole(angles, decisions))
}

/// The columns of a G1's joints that a file names, in its order; the wrists may be missing.
///
/// # Errors
/// Names of another count than the columns, or without one of our joints.
pub(super) fn named(
    file: &File<'_>,
    (angles, name): (&Array, &str),
    names: &[String],
    decisions: &mut Vec<String>,
) -> Result<(Array, Vec<String>), MotionError> {
    angles.check(file, name, &[names.len()], super::file::array::ANGLES)?;
    decisions.push("joints by the file's names".into());
    let (angles, names) = whole(angles, names.to_vec(), decisions);
    match joints::columns(&names) {
        Ok(columns) => {
            lean::say_others(&columns.others_of(&angles), decisions);
            Ok((angles, names))
        }
        Err(missing) => Err(file.unusable(
            &format!("names no joint {missing}"),
            "expected the joints of the G1, as left_knee_joint",
        )),
    }
}

/// Rows of 23 joints without names, which were read in our own order, in the order that fits; and how it
/// was told.
///
/// # Errors
/// Rows that could be either order.
pub(super) fn of_rows(file: &File<'_>, rows: Vec<Row>) -> Result<(Vec<Row>, String), MotionError> {
    let values = rows.iter().flat_map(|row| row.joints).collect();
    let angles = Array::of(vec![rows.len(), JOINTS], values, false).expect("23 joints a row");
    let (order, told) = plausible(&angles).map_err(|told| {
        file.unusable(
            &format!("has 23 joints without names that could be in two orders ({told})"),
            "add a header that names the columns: x,y,z,qw,qx,qy,qz,left_hip_pitch_joint,…",
        )
    })?;
    let (_, names) = order.whole(&angles, &mut Vec::new());
    let columns = joints::columns(&names).expect("both orders have all joints");
    let reread = |row: Row| {
        // The wrists that an order lacks stand behind its columns.
        let angle = |column: usize| row.joints.get(column).copied().unwrap_or(0.0);
        Row {
            joints: columns.ours.map(angle),
            dropped: columns.dropped.map(|column| column.map_or(0.0, angle)),
            ..row
        }
    };
    let told = format!("{}: {told}", order.told());
    Ok((rows.into_iter().map(reread).collect(), told))
}

/// Adds the wrists, at zero, if the columns lack them.
pub(super) fn whole(
    angles: &Array,
    mut names: Vec<String>,
    decisions: &mut Vec<String>,
) -> (Array, Vec<String>) {
    let width = names.len();
    for wrist in ["left_wrist_roll", "right_wrist_roll"] {
        if !names.iter().any(|name| joints::short(name) == wrist) {
            names.push(wrist.into());
        }
    }
    if names.len() > width {
        decisions.push("wrists are not in the file: at zero".into());
    }
    let mut values = Vec::with_capacity(angles.frames() * names.len());
    for i in 0..angles.frames() {
        values.extend_from_slice(angles.frame(i));
        values.resize(values.len() + names.len() - width, 0.0);
    }
    let array = Array::of(vec![angles.frames(), names.len()], values, false);
    (array.expect("every frame has a number per name"), names)
}

#[cfg(test)]
#[path = "order_tests.rs"]
pub(super) mod tests;
