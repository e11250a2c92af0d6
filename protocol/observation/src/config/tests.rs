//! The section as it is written, and what is refused.

use super::*;

fn read(text: &str) -> ObservationConfig {
    toml::from_str(text).unwrap()
}

fn refusal(text: &str) -> String {
    read(text).validate().unwrap_err().to_string()
}

#[test]
fn what_is_not_said_is_the_papers_list() {
    assert_eq!(read(""), ObservationConfig::default());
    let partly = read("[actor]\npast = 4");
    assert_eq!(partly.actor.terms, PAPER_ACTOR);
    assert_eq!(partly.critic.terms, ["actor"]);
    assert_eq!(partly.discriminator.terms, PAPER_DISCRIMINATOR);
    // Height, six more of the pelvis' velocity, …: five times as many numbers.
    assert_eq!(partly.tables().unwrap().actor.width(), 5 * g1::OBSERVATION);
}

#[test]
fn one_term_may_be_otherwise_and_is_written_back() {
    let text = "[actor]\nterms = ['gravity', 'joint_velocity']\npast = 1\n\
                [actor.term.joint_velocity]\nscale = 0.05\nclip = 30.0\npast = 5";
    let config = read(text);
    // 3·2 + 23·6
    assert_eq!(config.tables().unwrap().actor.width(), 6 + 6 * g1::JOINTS);
    assert_eq!(read(&toml::to_string(&config).unwrap()), config);
    let default = toml::to_string(&ObservationConfig::default()).unwrap();
    assert_eq!(read(&default), ObservationConfig::default());
    assert!(!default.contains("scale"), "{default}");
}

#[test]
fn what_cannot_be_seen_is_refused_with_its_place_and_a_remedy() {
    for (text, path, remedy) in [
        ("[actor]\nterms = []", "actor.terms", "at least one"),
        ("[actor]\nterms = ['hight']", "actor.terms[0]", "height"),
        ("[actor]\nterms = ['actor']", "actor.terms[0]", "height"),
        (
            "[actor]\nterms = ['gravity', 'gravity']",
            "actor.terms[1]",
            "once",
        ),
        ("[actor]\npast = 33", "actor.past", "0 to 32"),
        (
            "[actor.term.gravity]\npast = 99",
            "actor.term.gravity.past",
            "0 to 32",
        ),
        (
            "[actor.term.gravity]\nscale = 0.0",
            "actor.term.gravity.scale",
            "above 0",
        ),
        (
            "[actor.term.gravity]\nscale = nan",
            "actor.term.gravity.scale",
            "above 0",
        ),
        (
            "[actor.term.gravity]\nnoise = -1.0",
            "actor.term.gravity.noise",
            "from 0",
        ),
        (
            "[actor.term.gravity]\nclip = inf",
            "actor.term.gravity.clip",
            "above 0",
        ),
        (
            "[actor.term.friction]\nscale = 2.0",
            "actor.term.friction",
            "name it in terms",
        ),
        (
            "[critic]\nterms = ['height', 'actor']",
            "critic.terms",
            "first",
        ),
        ("[critic]\nterms = []", "critic.terms", "at least one"),
        ("[critic]\npast = 3", "critic.past", "observation.actor"),
        (
            "[critic.term.height]\nscale = 2.0",
            "critic.term.height",
            "name it in terms",
        ),
        (
            "[critic]\nterms = ['actor', 'friction', 'actor']",
            "critic.terms[2]",
            "once",
        ),
        (
            "[critic]\nterms = ['actor', 'friction', 'heigth']",
            "critic.terms[2]",
            "did you mean `height`?",
        ),
        // What no name is near to is answered with what the list may hold.
        (
            "[critic]\nterms = ['zzzz']",
            "critic.terms[0]",
            "known: `actor`, `height`",
        ),
        (
            "[discriminator]\nterms = ['zzzz']",
            "discriminator.terms[0]",
            "known: `height`, `linear_velocity`, `angular_velocity`, `gravity`, `joint_position`, `joint_angle`, \
             `joint_velocity`, `key_bodies`",
        ),
        (
            "[actor.term.gravty]\nscale = 2.0",
            "actor.term.gravty",
            "did you mean `gravity`?",
        ),
        (
            "[discriminator]\nterms = ['command']",
            "discriminator.terms[0]",
            "reference motion has no such thing; known: `height`, ",
        ),
        (
            "[discriminator]\nterms = ['foot_forces']",
            "discriminator.terms[0]",
            "reference motion",
        ),
        (
            "[discriminator.term.height]\nclip = 0.0",
            "discriminator.term.height.clip",
            "above 0",
        ),
    ] {
        let said = refusal(text);
        assert!(
            said.starts_with(&format!("{path} = ")) && said.contains(remedy),
            "{text}: {said}"
        );
    }
    for unknown in [
        "[discriminator]\npast = 2",
        "[actor.term.gravity]\nnois = 1.0",
        "[actors]",
    ] {
        assert!(
            toml::from_str::<ObservationConfig>(unknown).is_err(),
            "{unknown}"
        );
    }
}
