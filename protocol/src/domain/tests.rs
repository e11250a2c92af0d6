//! One run, one domain.

use super::*;

#[test]
fn fnv1a_gives_the_published_vectors() {
    // From the FNV reference page: empty input is the offset basis, "a" is af63dc4c8601ec8c.
    assert_eq!(fnv1a([].iter()), 0xcbf2_9ce4_8422_2325);
    assert_eq!(fnv1a(b"a".iter()), 0xaf63_dc4c_8601_ec8c);
}

#[test]
fn a_run_has_one_domain_whatever_its_path_is_called() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("walk");
    let other = folder.path().join("run");
    fs::create_dir(&run).unwrap();
    fs::create_dir(&other).unwrap();
    let domain = Domain::for_run(&run).unwrap();
    assert_eq!(domain, Domain::for_run(&other.join("../walk")).unwrap());
    assert_ne!(domain, Domain::for_run(&other).unwrap());
    // Unix socket paths end at 107 bytes; iceoryx2 adds about 60.
    assert!(domain.root().as_os_str().len() < 45, "{:?}", domain.root());
    assert!(domain.leftovers().unwrap().is_empty());
}

#[test]
fn a_missing_run_folder_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("nowhere");
    let error = Domain::for_run(&missing).unwrap_err();
    assert!(error.to_string().contains("nowhere"), "{error}");
}
