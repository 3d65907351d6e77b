use super::*;

#[test]
fn what_is_embedded_comes_back_to_the_byte() {
    let origin = Origin { recipe: "a = '<&>'\n".into(), source: b"\x00\xffsource".to_vec() };
    let svg = "<?xml version='1.0'?><svg xmlns='http://www.w3.org/2000/svg' a='>'><path d='M0,0'/></svg>";
    let with = origin.embed(svg).unwrap();
    assert_eq!(Origin::read(&with).unwrap().as_ref(), Some(&origin));
    assert_eq!(Origin::read(svg).unwrap(), None);
    let newer = Origin { recipe: "b".into(), ..origin.clone() };
    let again = newer.embed(&with).unwrap();
    assert_eq!(Origin::read(&again).unwrap(), Some(newer));
    assert_eq!(again.matches("<metadata>").count(), 1);
    let licensed = with.replace("</metadata>", "<licence/></metadata>");
    assert!(origin.embed(&licensed).unwrap().contains("<licence/></metadata>"));
    assert!(Origin::read(&with.replace("gzip base64\">", "gzip base64\">!")).is_err());
}
