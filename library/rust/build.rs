//! Compiles bsm.c: the one in the crate, or in a checkout the one that `tools.amalgamate` makes.
//!
//! The compiler is `CC_<target>`, `TARGET_CC` (`HOST_CC` if the target is this machine) or `CC`; `CFLAGS` and `AR` are
//! looked up in the same way, as by the crate `cc`. Without them it is `cc`, or the usual cross-compiler of the target.
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

fn run(command: &mut Command) {
    let status =
        command.status().unwrap_or_else(|error| panic!("{command:?}: {error}; set CC_<target>, TARGET_CC or CC"));
    assert!(status.success(), "{command:?} failed");
}

/// A setting of the environment for the target: the most specific name wins.
fn setting(name: &str, target: &str) -> Option<String> {
    let kind = if env::var("HOST").unwrap() == target { "HOST" } else { "TARGET" };
    let under = target.replace('-', "_");
    [format!("{name}_{target}"), format!("{name}_{under}"), format!("{kind}_{name}"), name.into()].into_iter().find_map(
        |name| {
            println!("cargo:rerun-if-env-changed={name}");
            env::var(name).ok()
        },
    )
}

/// The prefix of cross-compilers for GNU targets: `aarch64-linux-gnu` for `aarch64-unknown-linux-gnu`.
fn gnu_prefix(target: &str) -> Option<String> {
    let parts: Vec<&str> = target.split('-').collect();
    match parts[..] {
        [processor, _, "windows", "gnu"] => Some(format!("{processor}-w64-mingw32")),
        [processor, _, "linux", abi] if abi.starts_with("gnu") => Some(format!("{processor}-linux-{abi}")),
        _ => None,
    }
}

/// The command of a tool, with its first arguments: what the environment says, or what is usual for the target.
fn tool(name: &str, native: &str, of_gnu: &str, of_clang: &[&str], target: &str) -> Vec<String> {
    if let Some(given) = setting(name, target) {
        return given.split_whitespace().map(String::from).collect();
    }
    match gnu_prefix(target) {
        _ if env::var("HOST").unwrap() == target && !target.ends_with("msvc") => vec![native.into()],
        Some(prefix) => vec![format!("{prefix}-{of_gnu}")],
        None => of_clang.iter().map(|word| word.to_string()).collect(),
    }
}

fn command(words: &[String]) -> Command {
    let mut command = Command::new(&words[0]);
    command.args(&words[1..]);
    command
}

fn main() {
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR").unwrap());
    let out = PathBuf::from(env::var("OUT_DIR").unwrap());
    let target = env::var("TARGET").unwrap();
    let mut source = here.join("bsm.c");
    if !source.is_file() {
        let checkout: &Path = &here.join("../..");
        let python = env::var("PYTHON").unwrap_or_else(|_| "python3".into());
        run(Command::new(python).args(["-m", "tools.amalgamate"]).arg(&out).current_dir(checkout));
        source = out.join("bsm.c");
        for folder in ["library", "codec", "bitstream", "tools/amalgamate.py", "spec/priors.bin", "spec/start.bin"] {
            println!("cargo:rerun-if-changed={}", checkout.join(folder).display());
        }
    }
    let is_windows = target.contains("windows");
    let clang = ["clang".into(), format!("--target={target}")];
    let flags = setting("CFLAGS", &target).unwrap_or_else(|| "-O3".into());
    let object = out.join("bsmdec.o");
    let mut compile = command(&tool("CC", "cc", "gcc", &[&clang[0], &clang[1]], &target));
    compile.args(["-std=gnu11", "-ffp-contract=off", "-fno-math-errno", "-w", "-c"]);
    compile.args(if is_windows { [].as_slice() } else { ["-fPIC"].as_slice() });
    run(compile.args(flags.split_whitespace()).arg(&source).arg("-o").arg(&object));
    let library = out.join(if target.ends_with("msvc") { "bsmdec.lib" } else { "libbsmdec.a" });
    let _ = fs::remove_file(&library);
    run(command(&tool("AR", "ar", "ar", &["llvm-ar"], &target)).arg("crs").arg(&library).arg(&object));
    println!("cargo:rustc-link-search=native={}", out.display());
    println!("cargo:rustc-link-lib=static=bsmdec");
    if env::var("CARGO_CFG_UNIX").is_ok() {
        println!("cargo:rustc-link-lib=m");
    }
}
