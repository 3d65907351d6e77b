use super::applies;

#[test]
fn a_light_screen() {
    for yes in ["", "all", "screen", "print, screen", "not print", "only screen and (prefers-color-scheme: light)"] {
        assert_eq!(applies(yes), Some(true), "{yes}");
    }
    for no in ["print", "not screen", "(prefers-color-scheme:dark)", "print and (min-width: 1px)"] {
        assert_eq!(applies(no), Some(false), "{no}");
    }
    for unknown in ["(min-width: 600px)", "screen and (max-width: 3em)", "print, (width > 3px)"] {
        assert_eq!(applies(unknown), None, "{unknown}");
    }
}
