//! Lists that are allowed and odd: what a network cannot see although its work is about it.
//!
//! Separate because it is no refusal: a policy for one command needs to see none. But who leaves a term out by mistake learns
//! of it after hours, by a robot that does not do as it is told.

use crate::table::Table;
use crate::tables::Tables;
use crate::term::Kind;

impl Tables {
    /// A sentence for each thing that a list leaves out and whose absence is rarely meant.
    pub fn oddities(&self) -> Vec<String> {
        let mut said = Vec::new();
        if !has(&self.actor, "command") {
            said.push(
                "[observation] actor.terms has no `command`: the policy cannot see what it is told to do".to_owned(),
            );
        }
        if !feels_joints(&self.actor) {
            said.push(
                "[observation] actor.terms has nothing of the joints: the policy cannot see how its limbs are"
                    .to_owned(),
            );
        }
        if let Some(critic) = &self.critic {
            let sees = |what: &dyn Fn(&Table) -> bool| {
                what(&critic.own) || (critic.sees_actor && what(&self.actor))
            };
            if !sees(&|table| has(table, "command")) {
                said.push(
                    "[observation] critic.terms has no `command`, nor `actor` with one: the critic cannot see what the \
                     pay depends on"
                        .to_owned(),
                );
            }
        }
        if !feels_joints(&self.discriminator) {
            said.push(
                "[observation] discriminator.terms has nothing of the joints: the discriminator cannot see how limbs \
                 move, and any gait passes for human"
                    .to_owned(),
            );
        }
        said
    }
}

fn has(table: &Table, name: &str) -> bool {
    table.entries().iter().any(|entry| entry.term.name == name)
}

/// Positions or velocities of joints, or of the bodies that they move.
fn feels_joints(table: &Table) -> bool {
    let of_joints = |kind| matches!(kind, Kind::JointPosition | Kind::JointVelocity);
    let entries = table.entries().iter();
    let mut terms = entries.map(|entry| entry.term);
    terms.any(|term| of_joints(term.kind) || term.name == "key_bodies")
}

#[cfg(test)]
mod tests {
    use crate::ObservationConfig;

    fn oddities(text: &str) -> Vec<String> {
        let config: ObservationConfig = toml::from_str(text).unwrap();
        config.tables().unwrap().oddities()
    }

    #[test]
    fn the_papers_lists_are_not_odd() {
        assert_eq!(oddities(""), [""; 0]);
    }

    #[test]
    fn each_list_is_asked_for_what_its_work_is_about() {
        for (lists, list, lacks) in [
            (
                "actor.terms = ['height', 'joint_angle']",
                "actor",
                "command",
            ),
            ("actor.terms = ['command', 'gravity']", "actor", "joints"),
            (
                "critic.terms = ['height', 'joint_angle']",
                "critic",
                "command",
            ),
            (
                "discriminator.terms = ['height', 'gravity']",
                "discriminator",
                "joints",
            ),
        ] {
            let said = oddities(lists);
            assert_eq!(said.len(), 1, "{said:?}");
            let named = said[0].contains(&format!("{list}.terms")) && said[0].contains(lacks);
            assert!(named, "{said:?}");
        }
        // What the actor lacks, a critic that sees with it lacks too; one of its own may have it.
        let blind = "actor.terms = ['joint_angle']\n";
        let critic = |terms: &str| oddities(&format!("{blind}critic.terms = [{terms}]")).len();
        assert_eq!(critic("'actor', 'friction'"), 2);
        assert_eq!(critic("'actor', 'command'"), 1);
        assert_eq!(critic("'command'"), 1);
        assert_eq!(oddities("discriminator.terms = ['key_bodies']"), [""; 0]);
    }
}
