//! Compiles bsmdec.c: the one that is packed with the crate, or in a checkout the one that `tools.amalgamate` makes.
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

fn run(command: &mut Command) {
    let status = command.status().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(status.success(), "{command:?} failed");
}

fn main() {
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR").unwrap());
    let out = PathBuf::from(env::var("OUT_DIR").unwrap());
    let mut source = here.join("bsmdec.c");
    if !source.is_file() {
        let checkout: &Path = &here.join("../..");
        let python = env::var("PYTHON").unwrap_or_else(|_| "python3".into());
        run(Command::new(python).args(["-m", "tools.amalgamate"]).arg(&out).current_dir(checkout));
        source = out.join("bsmdec.c");
        for folder in ["engine", "codec", "bitstream", "tools/amalgamate.py", "spec/priors.bin"] {
            println!("cargo:rerun-if-changed={}", checkout.join(folder).display());
        }
    }
    let compiler = env::var("CC").unwrap_or_else(|_| "cc".into());
    let flags = env::var("CFLAGS").unwrap_or_else(|_| "-O3".into());
    let object = out.join("bsmdec.o");
    let mut command = Command::new(compiler);
    command.args(["-std=gnu11", "-ffp-contract=off", "-fno-math-errno", "-fPIC", "-w", "-c"]);
    run(command.args(flags.split_whitespace()).arg(&source).arg("-o").arg(&object));
    let library = out.join("libbsmdec.a");
    let _ = fs::remove_file(&library);
    run(Command::new(env::var("AR").unwrap_or_else(|_| "ar".into())).arg("crs").arg(&library).arg(&object));
    println!("cargo:rustc-link-search=native={}", out.display());
    println!("cargo:rustc-link-lib=static=bsmdec");
    if env::var("CARGO_CFG_UNIX").is_ok() {
        println!("cargo:rustc-link-lib=m");
    }
}
