//! The engines against converged solutions, with the bounds that they are trusted within.

use fidelity::{Case, Engine, Row, Traces, cases, engines, rows};
use g1::JOINT_TABLE;

fn joint_error(engine: Engine, case: &Case, finer: usize, seconds: f64) -> f64 {
    let (trace, truth) = (engine.run(case, finer), engines::reference(case));
    let at = (seconds / 0.005_f64).round() as usize - 1;
    let pairs = trace.frames[at].joints.iter().zip(&truth.frames[at].joints);
    let sum: f64 = pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    (sum / 23.0).sqrt()
}

#[test]
fn the_tumble_stays_away_from_the_stops_for_which_it_has_no_solution() {
    for frame in engines::reference(&cases::tumble()).frames {
        for (joint, q) in JOINT_TABLE.iter().zip(frame.joints) {
            let q = f64::from(q);
            assert!(joint.lower < q && q < joint.upper, "{} at {q}", joint.name);
        }
    }
}

#[test]
fn both_engines_go_to_the_solution_as_their_step_goes_to_zero() {
    // rapier shares no line with the solution, so this judges the equations of motion, too. Both are
    // of first order: a tenth of the step, a tenth of the error, and single precision besides.
    for engine in [Engine::Batched, Engine::Rapier] {
        for case in [cases::tumble(), cases::posing()] {
            let (coarse, fine) = (
                joint_error(engine, &case, 1, 0.5),
                joint_error(engine, &case, 10, 0.5),
            );
            assert!(coarse < 0.006, "{engine:?}, {}: {coarse} rad", case.name);
            assert!(
                fine < 0.2 * coarse,
                "{engine:?}, {}: {fine} of {coarse} rad",
                case.name
            );
        }
    }
}

/// MuJoCo 4.0.0's errors in the same cases, by `deploy/fidelity.py`, in the order of the table. In the
/// tumble both engines take the same steps, so that rounding decides: half a percent is let through.
const MUJOCO: [f64; 24] = [
    1.005 * 0.000_408, // tumble, rad
    1.005 * 0.001_126,
    1.005 * 0.002_922,
    0.000_849, // posing, rad
    0.000_386,
    1.03, // drop: mm, rad, rad
    0.003_05,
    0.006_80,
    0.227, // squat: mm, rad, rad
    0.001_84,
    0.001_83,
    0.003_22, // stand: mm, N, mm
    0.004_17,
    0.081_5,
    2.21,  // creep, mm
    0.317, // stops, rad: knee, hip roll, ankle pitch, elbow
    0.120,
    0.321,
    0.236,
    0.000_664, // legs meeting: rad, mm
    32.6,
    0.002_38, // arm meeting: rad, mm
    20.0,
    0.0, // stress: MuJoCo breaks in half of the runs, which is no bound
];

#[test]
fn the_batched_engine_errs_no_more_than_mujoco() {
    let traces = Traces::of(
        Engine::Batched,
        "batched",
        &cases::all(),
        &cases::stress(32),
    );
    let judged: Vec<Row> = rows(&traces).into_iter().filter(|row| row.judged).collect();
    assert_eq!(judged.len(), MUJOCO.len());
    for (row, bound) in judged.iter().zip(MUJOCO) {
        let value = row.value.expect("every case was run");
        assert!(
            value <= bound,
            "{}: {value} {}, bound {bound}",
            row.name,
            row.unit
        );
    }
}
