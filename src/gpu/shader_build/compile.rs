//! Compilation of GLSL to SPIR-V for Vulkan 1.3, with shaderc.

use std::fs;
use std::path::Path;

use shaderc::{
    CompileOptions, Compiler, EnvVersion, OptimizationLevel, ResolvedInclude, ShaderKind,
    SpirvVersion, TargetEnv,
};

fn stage_kind(path: &Path) -> Option<ShaderKind> {
    match path.extension()?.to_str()? {
        "vert" => Some(ShaderKind::Vertex),
        "geom" => Some(ShaderKind::Geometry),
        "frag" => Some(ShaderKind::Fragment),
        "comp" => Some(ShaderKind::Compute),
        _ => None,
    }
}

/// Compiles the stage `name`, a path relative to the shader folder, followed by the macros of a variant as `+A+B`. Includes are
/// looked up in the `include` subfolder. With `debug`, names and line numbers are kept and nothing is optimised.
///
/// # Errors
/// The compiler's messages, as `file:line: message`.
pub fn compile(
    compiler: &Compiler,
    shaders: &Path,
    name: &str,
    debug: bool,
) -> Result<Vec<u32>, String> {
    let mut parts = name.split('+');
    let path = &shaders.join(parts.next().unwrap_or_default());
    let source = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let kind = stage_kind(path).ok_or_else(|| format!("{}: no stage", path.display()))?;
    let folder = shaders.join("include");
    let mut options = CompileOptions::new().map_err(|e| format!("shaderc: {e}"))?;
    options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_3 as u32);
    // In SPIR-V 1.6 the work group size may be given by constants (LocalSizeId), which requires the feature maintenance4 and
    // which rspirv does not parse.
    options.set_target_spirv(match kind {
        ShaderKind::Compute => SpirvVersion::V1_5,
        _ => SpirvVersion::V1_6,
    });
    options.set_warnings_as_errors();
    for defined in parts {
        options.add_macro_definition(defined, None);
    }
    if debug {
        options.set_generate_debug_info();
        options.set_optimization_level(OptimizationLevel::Zero);
    } else {
        options.set_optimization_level(OptimizationLevel::Performance);
    }
    options.set_include_callback(|name, _, from, _| include(&folder, name, from));
    compiler
        .compile_into_spirv(
            &source,
            kind,
            &path.to_string_lossy(),
            "main",
            Some(&options),
        )
        .map(|artifact| artifact.as_binary().to_vec())
        .map_err(|e| compiler_message(&e))
}

fn include(folder: &Path, name: &str, from: &str) -> Result<ResolvedInclude, String> {
    let path = folder.join(name);
    let content = fs::read_to_string(&path)
        .map_err(|e| format!("{from} includes {}: {e}", path.display()))?;
    Ok(ResolvedInclude {
        resolved_name: path.to_string_lossy().into_owned(),
        content,
    })
}

/// Removes the summary that shaderc puts before its `file:line: message` lines.
fn compiler_message(error: &shaderc::Error) -> String {
    match error {
        shaderc::Error::CompilationError(_, text) => text.clone(),
        other => other.to_string(),
    }
}
