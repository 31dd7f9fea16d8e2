//! Real-time daylight whose numbers can be trusted: a model in the daylight of a place and a moment, in cd/m² and lux.
//!
//! # The frame
//!
//! ```text
//!  place + time ──► sun ──► sky cube ──► irradiance cube (geometry shader, gl_Layer, progressive)
//!                    │         │               │
//!  scene ─┬─► shadow map       │               │
//!         ├─► G-buffer         │               │
//!         └─► hierarchy ──► cells: irradiance of sky and bounces, in world space
//!                    │         │               │
//!                    └──► lighting ◄───────────┘ ◄── air between surfaces and eye
//!                              │
//!                         background ──► average ──► exposure ──► tone map ──► window | PNG | EXR
//!                                         ▲   ▲
//!   dome: the sky's true visibility, by   │   └── gather: the bounces, by rays from the pixels,
//!   maps or rays in its directions ───────┘       lit where they end by the sun and the cells
//! ```
//!
//! [`frame::Frame::record`] draws that picture from top to bottom. While something moves, [`frame::Frame::preview`] leaves the
//! average out. The picture is
//!
//! L = T (L_e + L_sun + L_sky + L_bounces) + L_air
//!
//! | term | value | in a single frame | in an average with `--visibility dome` |
//! |---|---|---|---|
//! | L_e | what a surface emits; sky, ground and the sun's disc where no surface is | material; sky cube, disc | the same |
//! | L_sun | (ρ_d/π (n·l) + ρ_s (r·l)^p) V E_sun | V by the shadow map | V by shadow maps of points of the disc |
//! | L_sky | ρ_d/π ∫ V(ω) L_sky(ω) cos θ dω + ρ_s L_sky(r) | diffuse: cells | diffuse: dome |
//! | | lobes of GGX ([`daylight::microfacet`]) instead of ρ_s (..), of what reflects by it | prefiltered sky, cells, a ray | rays |
//! | L_bounces | ρ_d/π E_bounces | cells | gathered rays |
//! | T, L_air | the air between surface and eye: transmittance, scattered light; 1 and 0 in scenes below 200 m, and with `--aerial off` | table of the air | the same, for each sample |
//!
//! with E_sun the sun's illuminance at normal incidence, V visibility, L_sky(ω) the sky cube without the sun's disc, and E_bounces the
//! irradiance of the light that other surfaces emit and reflect. Only diffuse reflection bounces; lobes of GGX show surfaces too.
//!
//! `--ambient ssao --bounces 0`, part of `--preset lecture`, shows the lecture's illumination model in single frames:
//!
//! L_e + L_r, L_r = ρ_d/π ((n·l) V E_sun + A E_sky(n)) + ρ_s ((r·l)^p V E_sun + L_sky(r))
//!
//! with A ambient occlusion in screen space (it dims sky light only) and E_sky the irradiance cube (it holds E, not E/π).
//!
//! # Rooms
//!
//! - [`daylight`]: the physics, CPU only, in `f64`; the reference that the shaders are tested against.
//! - [`scene`]: models, materials, textures, cameras, scene files, the hierarchy that rays go through; no device.
//! - [`gpu`]: Vulkan nouns; knows no pass by name.
//! - [`passes`]: passes in folders by topic; [`frame`] owns them. [`passes::bounces`]: the hierarchy on the device, the cells, the
//!   rays that are gathered; [`passes::dome`]: the sky by shadow maps.
//! - [`sensors`]: illuminance at points with all diffuse bounces, at a moment or over a year, by path tracing on the CPU; no device.
//! - [`lecture`]: every formula of the slides with its function, shader and test.
//! - [`validate`]: the device that is there against the CPU, reference values and closed forms; the tests of the device compare by it.
//! - [`compare`]: two pictures, how far apart: radiometric errors and FLIP.
//! - [`cli`] and [`options`]: text to options. [`commands`]: drivers of the one frame. [`output`]: files, whole or not at all.
//!
//! Imports run one way: commands → validate → frame, sensors → passes → gpu, scene, daylight; the last three import nothing of ours.
//!
//! # Conventions
//!
//! | what | convention |
//! |---|---|
//! | world | right-handed, metres, +Y up, +X east, −Z north |
//! | sun direction | unit vector toward the sun: (sin az cos el, sin el, −cos az cos el) |
//! | azimuth, elevation | degrees; azimuth clockwise from north; longitude positive east, latitude positive north |
//! | time | RFC 3339 with its UTC offset; never the machine's time zone |
//! | colour | linear RGB, BT.709 primaries, D65; Y = 0.2126 R + 0.7152 G + 0.0722 B is luminance |
//! | radiance, irradiance | cd/m² and lux on the CPU and in files; kcd/m² and klx in GPU images (half floats end at 65 504) |
//! | cube faces | +X −X +Y −Y +Z −Z with Vulkan's s/t orientation; texel centres at (i + ½)/N |
//! | depth | reversed Z, infinite far plane |
//! | matrices | named destination_from_source: `clip_from_view` |

#![cfg_attr(not(test), warn(clippy::too_many_lines))]

pub mod cli;
pub mod commands;
pub mod compare;
pub mod daylight;
pub mod error;
pub mod frame;
pub mod gpu;
pub mod lecture;
pub mod options;
pub mod output;
pub mod passes;
pub mod scene;
pub mod sensors;
pub mod validate;
