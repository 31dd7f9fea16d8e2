//! The stages of all shaders against what Vulkan guarantees: the required limits of the specification (table "Required Limits"), which
//! devices of phones may not exceed, and capabilities of SPIR-V that need no feature.

use super::shader::{BindingKind, Shader, Stage, compiled};

/// Most bindings of a kind in a stage.
const BINDINGS: [(BindingKind, usize, &str); 4] = [
    (BindingKind::StorageBuffer, 4, "storage buffers"),
    (BindingKind::StorageImage, 4, "storage images"),
    (BindingKind::UniformBuffer, 12, "uniform buffers"),
    (BindingKind::SampledImage, 16, "sampled images"),
];

/// Bytes of push constants, outputs of a fragment shader, invocations of a workgroup, its size along each axis.
const PUSH: u32 = 128;
const OUTPUTS: usize = 4;
const INVOCATIONS: u32 = 128;
const GROUP: [u32; 3] = [128, 128, 64];

/// Capabilities: Matrix, Shader and ImageQuery; Geometry, an optional feature, in geometry shaders and where fragments have the number of their
/// primitive.
const CAPABILITIES: [u32; 3] = [0, 1, 50];
const GEOMETRY: u32 = 2;
const NUMBERED: &str = "surfaces/triangles.frag";

/// What a stage uses beyond the limits.
fn excess(shader: &Shader) -> Vec<String> {
    let mut found = Vec::new();
    for (kind, most, name) in BINDINGS {
        let count = shader.bindings.iter().filter(|b| b.kind == kind).count();
        if count > most {
            found.push(format!("{count} {name}"));
        }
    }
    let push = super::block_size(shader.push.unwrap_or(&[]));
    if push > PUSH {
        found.push(format!("{push} bytes of push constants"));
    }
    if shader.stage == Stage::Fragment && shader.outputs > OUTPUTS {
        found.push(format!("{} outputs", shader.outputs));
    }
    if let Some(size) = shader.local_size {
        let is_large = size.iter().product::<u32>() > INVOCATIONS;
        if is_large || size.iter().zip(GROUP).any(|(edge, most)| *edge > most) {
            found.push(format!("workgroups of {size:?}"));
        }
    }
    let is_allowed = |capability: &u32| {
        CAPABILITIES.contains(capability)
            || (*capability == GEOMETRY
                && (shader.stage == Stage::Geometry || shader.name == NUMBERED))
    };
    let others = capabilities(shader.words).filter(|c| !is_allowed(c));
    found.extend(others.map(|c| format!("capability {c} (subgroups are 61 to 68)")));
    found
}

/// The operands of OpCapability (SPIR-V 2.3, 3.52.7): instructions after a header of five words, each with its length in the upper half of
/// its first word.
fn capabilities(words: &[u32]) -> impl Iterator<Item = u32> {
    const CAPABILITY: u32 = 17;
    let mut rest = &words[5..];
    std::iter::from_fn(move || {
        let (length, code) = (*rest.first()? >> 16, rest[0] & 0xffff);
        let operand = (code == CAPABILITY).then(|| rest[1]);
        rest = &rest[length.max(1) as usize..];
        operand
    })
}

#[test]
fn every_stage_keeps_within_what_each_device_has() {
    let found: Vec<String> = compiled::ALL
        .iter()
        .flat_map(|shader| {
            excess(shader)
                .into_iter()
                .map(|what| format!("{}: {what}", shader.name))
        })
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
    let tested = compiled::ALL.iter().map(|s| capabilities(s.words).count());
    assert!(compiled::ALL.len() > 50 && tested.min() > Some(0));
}

#[test]
fn excess_is_found() {
    let wide: &'static [_] = &[super::Binding {
        name: "buffer",
        binding: 0,
        kind: BindingKind::StorageBuffer,
        fields: &[],
    }; 5];
    // A header, then the capability GroupNonUniformArithmetic.
    let words: &'static [u32] = &[0x0723_0203, 0x0001_0500, 0, 1, 0, 2 << 16 | 17, 63];
    let shader = Shader {
        bindings: wide,
        outputs: 5,
        local_size: Some([16, 16, 1]),
        words,
        name: "wide",
        stage: Stage::Compute,
        push: None,
        constants: &[],
        #[cfg(feature = "hot-reload")]
        declared: "",
    };
    let found = excess(&shader).join("; ");
    for part in ["5 storage buffers", "[16, 16, 1]", "capability 63"] {
        assert!(found.contains(part), "{part}: {found}");
    }
}
