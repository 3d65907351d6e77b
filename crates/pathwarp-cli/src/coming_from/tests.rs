use super::*;

#[test]
fn words_are_found_as_people_type_them() {
    let commands = |word: &str| found(word).iter().map(ForeignWord::subcommand).collect::<Vec<_>>();
    assert_eq!(commands("puppet-warp tool"), [Some("mls"); 2]);
    assert_eq!(commands("Rotate"), [Some("affine")]);
    assert_eq!(commands("Free Distort"), [Some("projective")]);
    assert_eq!(commands("make with top object"), [Some("envelope")]);
    assert_eq!(commands("Pattern along Path LPE"), [Some("bend")]);
    assert!(commands("LIQUIFY").len() > 4 && commands("liquify").contains(&Some("swirl")));
    assert_eq!(commands("zipper"), [None]);
    assert!(commands("lattice deformation inkscape").contains(&Some("ffd")));
    assert!(commands("").is_empty() && commands("›").is_empty() && commands("unheard-of").is_empty());
}

#[test]
fn every_line_is_a_row() {
    let rows = TABLE.lines().filter(|l| !l.starts_with('#') && !l.trim().is_empty());
    assert_eq!(rows.clone().count(), all().count());
    assert!(rows.clone().all(|l| l.matches('|').count() == 2));
    for w in all() {
        assert!(w.words.iter().all(|w| !w.is_empty()), "{w:?}");
        assert!(w.command.is_some() || w.text.starts_with("Not there"), "{w:?}");
        for name in &w.words {
            assert!(found(name).contains(&w), "{name}");
        }
    }
}
