//! GLSL to SPIR-V for Vulkan 1.3, by shaderc.

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

/// Compiles the stage `name`, a path below the folder of all shaders, of a variant followed by its macros as `+A+B`; includes lie
/// in that folder's `include`. With `debug` it keeps names and lines, unoptimised.
///
/// # Errors
/// The compiler's lines, `file:line: message`.
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
    // In SPIR-V 1.6 the size of a work group may be a constant of its own (LocalSizeId), which takes the feature
    // maintenance4 and which rspirv does not read.
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

/// shaderc prefixes its `file:line: message` lines with a summary of its own, which would hide them.
fn compiler_message(error: &shaderc::Error) -> String {
    match error {
        shaderc::Error::CompilationError(_, text) => text.clone(),
        other => other.to_string(),
    }
}
