//! Help, exit codes and wrong usage.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use common::{CUBE, PILLOW, SCHEMES, arg, cage, code, run, run_on, stderr, stdout};

const COMMANDS: [&str; 9] =
    ["demo", "check", "patches", "mesh", "eval", "render", "analyze", "q", "spectrum"];

#[test]
fn help_lists_every_command_and_says_what_exit_codes_mean() {
    let help = stdout(&run(&["--help"]));
    assert!(COMMANDS.iter().all(|command| help.contains(&format!("\n  {command} "))));
    assert!(help.contains("Exit codes: 0 good, 1 the input cannot be used, 2 wrong usage"));
    assert!(help.contains("numbered from 0"));
}

#[test]
fn every_command_has_help_with_its_defaults_and_units() {
    for command in COMMANDS {
        assert!(stdout(&run(&[command, "--help"])).contains("Usage: evenlight"), "{command}");
    }
    let help = |command| stdout(&run(&[command, "--help"])).replace('\n', " ");
    assert!(help("patches").contains("[default: 6]"));
    for command in ["patches", "mesh", "eval", "render", "q", "spectrum"] {
        assert!(help(command).contains("[default: qas4]"), "{command}");
    }
    assert!(help("analyze").contains("[default: cc,qas4]"));
    assert!(help("mesh").contains("Segments per edge") && help("mesh").contains("[default: 8]"));
    assert!(help("eval").contains("K (1/length^2)") && help("eval").contains("[default: -]"));
    let render = help("render");
    assert!(render.contains("in pixels") && render.contains("in degrees"));
    assert!(render.contains("[default: 1200x900]") && render.contains("[default: 30,25]"));
    assert!(help("spectrum").contains("[default: 3..10]"));
    assert!(help("demo").contains("[default: evenlight-demo]"));
}

#[test]
fn help_says_what_every_scheme_is_and_which_valences_it_has() {
    for command in ["patches", "mesh", "eval", "render", "analyze", "q", "spectrum"] {
        let help = stdout(&run(&[command, "--help"]));
        // The rings beside creases, further down, can be `cc` too.
        let (until_creases, _) = help.split_once("--creases").unwrap_or((&help, ""));
        for scheme in SCHEMES {
            let mut lines = until_creases.lines().filter(|l| l.contains(&format!("- {scheme}:")));
            let about = lines.next().unwrap();
            assert!(["bi-", "per ring", "C1"].iter().all(|word| about.contains(word)), "{about}");
            assert_eq!(lines.next(), None, "{command}");
        }
        let words: Vec<&str> = help.split_whitespace().collect();
        let help = words.join(" ");
        for valences in ["2 to 1024 (cc)", "3 and 5 to 10 (eg, pas3", "3 and 5 to 16 (eg, pas3"] {
            assert!(help.contains(valences), "{command}: {valences}");
        }
    }
}

#[test]
fn wrong_usage_is_exit_code_2_with_a_message_on_stderr() {
    let pillow = cage(PILLOW);
    let pillow = arg(&pillow);
    for (args, message) in [
        (&["frobnicate"][..], "unrecognized subcommand"),
        (&["check"], "required"),
        (&["check", pillow, "--frob"], "unexpected argument"),
        (&["mesh", pillow, "-o", "a.ply", "--scheme", "loop"], "cc, eg, pas3, pas4, qas3, qas4"),
        (&["mesh", pillow, "-o", "a.ply", "--rate", "0"], "not in 1..=1024"),
        (&["mesh", pillow, "-o", "a.step"], "it can be .obj, .ply, .stl"),
        (&["mesh", pillow, "-o", "-"], "choose --format obj or ply or stl"),
        (&["patches", pillow, "-o", "a.obj"], "it can be .bv, .json"),
        (&["patches", pillow, "-o", "noextension"], "it can be .bv, .json"),
        (&["patches", pillow, "-o", "a.bv", "--rings", "49"], "not in 0..=48"),
        (&["render", pillow, "-o", "a.jpg"], "it can be .png"),
        (&["render", pillow, "-o", "a.png", "--size", "0x5"], "1 to 16384 pixels"),
        (&["render", pillow, "-o", "a.png", "--size", "large"], "two numbers with 'x'"),
        (&["render", pillow, "-o", "a.png", "--view", "1"], "two numbers with ','"),
        (&["render", pillow, "-o", "a.png", "--target", "1,2"], "three numbers"),
        (
            &["render", pillow, "-o", "a.png", "--scheme", "cc", "--compare", "cc,eg"],
            "cannot be used",
        ),
        (&["render", pillow, "-o", "a.png", "--at", "0", "--view", "1,2"], "cannot be used"),
        (&["eval", "-", "--points", "-"], "cage and points cannot both come from stdin"),
        (&["eval", pillow, "--points", "-", "--q", "-"], "points and --q cannot both come"),
        (&["mesh", "-", "-o", "a.ply", "--q", "-"], "cage and --q cannot both come from stdin"),
        (&["spectrum", "--valence", "10..3"], "inclusive range"),
        (&["spectrum", "--valence", "many"], "inclusive range"),
        (&["check", pillow, "--threads", "0"], "not in 1..=1024"),
    ] {
        let output = run(args);
        assert_eq!(code(&output), 2, "{args:?}");
        assert!(stderr(&output).contains(message), "{args:?}: {}", stderr(&output));
        assert!(output.stdout.is_empty(), "{args:?}");
    }
}

#[test]
fn a_format_option_stands_in_for_the_extension() {
    let to_stdout =
        |format| run_on(CUBE, &["mesh", "-", "-o", "-", "--rate", "1", "--format", format]);
    assert!(stdout(&to_stdout("obj")).starts_with("v "));
    assert!(to_stdout("ply").stdout.starts_with(b"ply\n"));
    assert_eq!(to_stdout("stl").stdout.len(), 84 + 12 * 50);
}

#[test]
fn options_may_stand_before_and_after_the_command() {
    let pillow = cage(PILLOW);
    let before = run(&["--quiet", "--threads", "2", "check", arg(&pillow)]);
    let after = run(&["check", arg(&pillow), "-q", "--threads", "2"]);
    assert_eq!(stdout(&before), stdout(&after));
}

#[test]
fn completions_name_the_commands() {
    let script = stdout(&run(&["completions", "bash"]));
    assert!(COMMANDS.iter().all(|command| script.contains(command)));
}
