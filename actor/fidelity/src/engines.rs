//! The engines at any step, and the reference.
//!
//! Separate because measures must not know what made a trace.

use crate::case::{Case, Gains, STEP};
use crate::trace::{Frame, Trace};
use dynamics::{Ground, Motors, Reference, Robots, Solver};
use nalgebra::Vector3;
use sim::{Variation, World};

/// Gauss–Seidel sweeps of the batched solver.
const SWEEPS: usize = 4;
/// Step of the fourth-order reference, s.
const REFERENCE_STEP: f64 = 1e-4;

/// What simulates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// The batched solver in single precision.
    Batched,
    /// rapier.
    Rapier,
}

impl Engine {
    /// Runs a case at steps of `STEP / finer`.
    pub fn run(self, case: &Case, finer: usize) -> Trace {
        match self {
            Self::Batched => batched(case, finer),
            Self::Rapier => rapier(case, finer),
        }
    }
}

fn motors(gains: &Gains) -> Motors<f32> {
    Motors {
        stiffness: gains.stiffness,
        damping: gains.damping,
        effort: gains.effort,
    }
}

fn solver(case: &Case, finer: usize) -> Solver {
    Solver {
        dt: (STEP / finer as f64) as f32,
        sweeps: SWEEPS,
        motors: motors(&case.gains),
        ground: Ground::Plane,
        self_collision: true,
    }
}

fn batched(case: &Case, finer: usize) -> Trace {
    let mut robots = Robots::new(solver(case, finer), 1);
    robots.set_state(0, &case.start);
    let mut recorder = Recorder::new(case, finer);
    for step in 0..case.steps {
        robots.set_targets(0, case.target(step));
        for part in 0..finer {
            robots.push(0, recorder.push(step, part));
            robots.advance(1);
            recorder.feel(robots.effort(0, 1).foot_forces);
        }
        recorder.keep(step, || Frame::of(&robots.state(0)));
    }
    recorder.end(robots.is_sound(0))
}

fn rapier(case: &Case, finer: usize) -> Trace {
    let mut engine = sim::Engine::with_step((STEP / finer as f64) as f32);
    let mut world = World::new(&Variation::NOMINAL);
    world.set_state(&case.start);
    let gains = sim::Gains {
        stiffness: case.gains.stiffness,
        damping: case.gains.damping,
        effort: case.gains.effort,
    };
    let mut recorder = Recorder::new(case, finer);
    for step in 0..case.steps {
        for part in 0..finer {
            world.push(recorder.push(step, part));
            let exertion = world.physics_step(&mut engine, &gains, case.target(step));
            recorder.feel(exertion.foot_forces);
        }
        recorder.keep(step, || Frame::of(&world.state()));
    }
    recorder.end(world.is_sound())
}

/// The motion of a case without contacts and stops, by the equations of motion in double precision.
pub fn reference(case: &Case) -> Trace {
    let mut reference = Reference::new(&solver(case, 1), SWEEPS);
    reference.set_state(&case.start);
    let mut recorder = Recorder::new(case, 1);
    for step in 0..case.steps {
        reference.set_targets(case.target(step));
        reference.advance_smoothly((STEP / REFERENCE_STEP).round() as usize, REFERENCE_STEP);
        recorder.keep(step, || Frame::of(&reference.state()));
    }
    recorder.end(reference.state().is_finite())
}

/// Writes a trace.
struct Recorder<'a> {
    case: &'a Case,
    finer: usize,
    peak: f32,
    sum: f32,
    steps: usize,
    frames: Vec<Frame>,
}

impl<'a> Recorder<'a> {
    fn new(case: &'a Case, finer: usize) -> Self {
        Self {
            case,
            finer,
            peak: 0.0,
            sum: 0.0,
            steps: 0,
            frames: Vec::with_capacity(case.steps / case.every),
        }
    }

    /// What the robot's velocity changes by before a part of a step: kicks, and the pull, which acts
    /// on a whole robot as gravity does.
    fn push(&self, step: usize, part: usize) -> Vector3<f32> {
        let mut change = Vector3::zeros();
        if step >= self.case.pull_from {
            change += Vector3::from(self.case.pull) * (STEP / self.finer as f64) as f32;
        }
        if let Some(push) = self.case.push(step).filter(|_| part == 0) {
            change += Vector3::from(push);
        }
        change
    }

    fn feel(&mut self, forces: [f32; 2]) {
        let force = forces[0] + forces[1];
        self.peak = self.peak.max(force);
        self.sum += force;
        self.steps += 1;
    }

    fn keep(&mut self, step: usize, frame: impl FnOnce() -> Frame) {
        if (step + 1).is_multiple_of(self.case.every) {
            self.frames.push(Frame {
                peak: self.peak,
                force: self.sum / self.steps.max(1) as f32,
                ..frame()
            });
            (self.peak, self.sum, self.steps) = (0.0, 0.0, 0);
        }
    }

    fn end(self, sound: bool) -> Trace {
        Trace {
            case: self.case.name.clone(),
            dt: STEP / self.finer as f64,
            frames: self.frames,
            sound,
        }
    }
}
