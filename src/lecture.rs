//! The lecture *Skylight and irradiance environment maps* (DTU course 02564, Frisvad 2016), formula by formula.
//!
//! Each row names where a slide's formula is: the Rust function (a link that breaks the documentation when the name changes), the
//! shader in `shaders_glsl` with an identifier that is in it, and a test. `tests/structure/lecture.rs` keeps shaders and tests true.
//!
//! # The map
//!
//! | slide | formula | Rust | shader | test |
//! |---|---|---|---|---|
//! | Quote from Lord Rayleigh | I = I0 exp(-k λ⁻⁴ x) | [`rayleigh_1871`](crate::daylight::sunlight::rayleigh_1871) | – | `rayleigh_blue_is_lost_first` |
//! | Solar radiation | black body of 5800 K, the sun's spectrum | [`planck`](crate::daylight::spectrum::planck), [`extraterrestrial_radiance`](crate::daylight::sunlight::extraterrestrial_radiance); drawn by `skylight sky --plot` | – | `plots_are_whole_svg_files_with_their_curves` |
//! | Spectrum to RGB | ∫ C(λ) (x̄, ȳ, z̄) dλ | [`xyz_from_spectrum`](crate::daylight::spectrum::xyz_from_spectrum) | – | `cie_1931_colour_matching_functions` |
//! | Gamut mapping | RGB = M XYZ | [`rgb_from_xyz`](crate::daylight::colour::rgb_from_xyz), [`xyz_from_rgb`](crate::daylight::colour::xyz_from_rgb) | `include/colour.glsl`: `RGB_FROM_XYZ` | `srgb_matrices` |
//! | Gamut mapping | Y = 0.2126 R + 0.7152 G + 0.0722 B | [`luminance`](crate::daylight::colour::luminance) | `include/colour.glsl`: `luminance` | `white_is_white` |
//! | Tone mapping | (s R)^(1/γ) | [`linear_gamma`](crate::daylight::tone_curve::linear_gamma) | `include/tone_map.glsl`: `inverse_gamma` | `tone_curves` |
//! | Tone mapping | (1 - e^(-R))^(1/γ) | [`exponential`](crate::daylight::tone_curve::exponential) | `include/tone_curve.glsl`: `tone_exponential` | `tone_curves` |
//! | Analytical sky models | Preetham's L(θ, γ) | [`Preetham`](crate::daylight::preetham::Preetham), [`perez`](crate::daylight::preetham::perez) | `include/sky_preetham.glsl`: `perez` | `preetham_sky` |
//! | Analytical sky models | θ_s = π/2 - asin(sin ℓ sin δ - cos ℓ cos δ cos(π t/12)) | [`lecture`](crate::daylight::sun_position::lecture) | – | `lecture_formulas` |
//! | Analytical sky models | φ_s, corrected (below) | [`lecture`](crate::daylight::sun_position::lecture) | – | `the_printed_azimuth_mirrors_a_summer_sunrise` |
//! | Analytical sky models | δ(J), t from the clock | [`declination`](crate::daylight::sun_position::declination), [`solar_time`](crate::daylight::sun_position::solar_time) | – | `declination_and_equation_of_time` |
//! | Direct sunlight | L = Φ/(π A) | [`lecture_sun_radiance`](crate::daylight::sunlight::lecture_sun_radiance) | – | `the_lectures_numbers` |
//! | Direct sunlight | ω = A/(4 r²) | [`lecture_sun_solid_angle`](crate::daylight::sunlight::lecture_sun_solid_angle) | – | `the_lectures_numbers` |
//! | Direct sunlight | E = L ω ≈ 1383 W/m² | [`lecture_sun_irradiance`](crate::daylight::sunlight::lecture_sun_irradiance) | – | `the_lectures_numbers` |
//! | Precomputing a cube map | v_ijk = a_k + u_k (..) + b_k (..) | [`face_vector`](crate::daylight::cube::face_vector) | `include/cube.glsl`: `cube_direction` | `vulkans_table_is_met` |
//! | Environment mapping | r = i - 2 (n·i) n | [`Show::SkySpecular`](crate::options::Show::SkySpecular) | `include/lighting.glsl`: `reflect(` | `each_addend_is_in_the_picture_once` |
//! | Filling the background | i_w = V⁻¹ P⁻¹ p_n | [`Camera`](crate::scene::Camera) | `include/view.glsl`: `view_ray` | – |
//! | Sky irradiance and A | E ≈ A E_sky | [`Show::Sky`](crate::options::Show::Sky) | `include/lighting.glsl`: `ambient_occlusion` | `each_addend_is_in_the_picture_once` |
//! | Integrating skylight | E_N = 1/N Σ L cos θ/pdf | [`monte_carlo`](crate::daylight::irradiance::monte_carlo) | `include/irradiance.glsl`: `MONTE_CARLO` | `monte_carlo_meets_its_own_standard_error` |
//! | Integrating skylight | (θ, φ) = (acos √(1 - ξ1), 2π ξ2) | [`cosine_hemisphere`](crate::daylight::sampling::cosine_hemisphere) | `include/irradiance.glsl`: `random_direction` | `the_warps_have_the_moments_of_their_densities` |
//! | Integrating skylight | frame of n (below) | [`frisvad`](crate::daylight::tangent_frame::frisvad), [`duff`](crate::daylight::tangent_frame::duff) | `include/frame.glsl`: `frame_from_normal` | `tangent_frames` |
//! | Irradiance environment map | six faces by gl_Layer | [`IrradianceMethod`](crate::daylight::IrradianceMethod) | `sky/cube_faces.geom`: `gl_Layer` | `exact_of_a_64_cube` |
//! | Irradiance environment map | rnd(t) | [`rnd`](crate::daylight::sampling::rnd), [`tea`](crate::daylight::sampling::tea) | `include/random.glsl`: `rnd` | `rnd_is_uniform` |
//! | Illumination model | L_r = ρ_d/π ((n·l) V E_sun + A E_sky(n)) + ρ_s ((r·l)^p V E_sun + L_sky(r)) | [`Show`](crate::options::Show) | `include/lighting.glsl`: `r_dot_l` | `each_addend_is_in_the_picture_once` |
//! | Rendering equation | L_e | [`Material::emission`](crate::scene::Material::emission) | `include/lighting.glsl`: `emitted` | `a_panel_shows_what_it_emits_and_nothing_more_at_night` |
//! | Rendering equation | ρ_s V(x, r) L_sky(r), V over the lobe around r | [`Reflections::Hidden`](crate::options::Reflections::Hidden) | `include/dome_specular.glsl`: `along_r` | `a_mirror_on_the_floor_shows_the_sky_in_the_opening_and_nowhere_else` |
//! | Rendering equation | V(x, ω) L_sky(ω) cos θ over the sky | [`SkySampler`](crate::daylight::sky_sampler::SkySampler) | `include/dome_gather.glsl`: `light_of_directions` | `a_room_with_an_opening_gets_the_light_of_its_configuration_factor` |
//! | Rendering equation | ρ_d/π ∫ L(ω) cos θ dω over what other surfaces emit and reflect | [`Bounces`](crate::options::Bounces) | `bounces/bounces_gather.comp`: `gathered` | `each_addend_is_in_the_picture_once` |
//! | Rendering equation | the same for a sensor, all bounces | [`measure`](crate::sensors::measure) | – | `the_wall_of_a_sphere_with_an_opening_has_the_light_of_all_bounces` |
//!
//! # The slips, and what is done instead
//!
//! **Azimuth sign.** The printed denominator is cos ℓ sin δ - sin ℓ cos δ cos(π t/12); its first term must be negative. As printed the
//! formula mirrors the declination: right at the equinoxes and on the meridian, 21° off on average over daytime, 80° at worst.
//!
//! **arctan.** The quotient's arctan is only in ±90°, so half of the sky is lost; `atan2` of the two parts keeps the quadrant. φ_s then
//! counts from south toward west: azimuth from north, clockwise, is 180° + φ_s.
//!
//! | day | solar time | latitude | printed (with atan2) | corrected | difference |
//! |---|---|---|---|---|---|
//! | 172 | 6 | 40 | 108.4 | 71.6 | 36.8 |
//! | 172 | 9 | 55.8 | 139.5 | 115.7 | 23.8 |
//! | 172 | 12 | 55.8 | 180.0 | 180.0 | 0.0 |
//! | 81 | 9 | 45 | 125.3 | 125.3 | 0.0 |
//! | 200 | 10 | 45 | 150.5 | 124.3 | 26.2 |
//! | 355 | 15 | 55.8 | 244.2 | 220.5 | 23.8 |
//!
//! ```
//! use skylight::daylight::sun_position::{declination, lecture};
//! let table = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/src/lecture.rs"));
//! let mut rows = 0;
//! for line in table.lines().filter_map(|l| l.strip_prefix("//! | ")) {
//!     let cells: Vec<f64> = line.split('|').filter_map(|c| c.trim().parse().ok()).collect();
//!     let &[day, hours, latitude, printed, corrected, difference] = &cells[..] else { continue };
//!     let (d, l) = (declination(day as u32), latitude.to_radians());
//!     let t = std::f64::consts::PI * hours / 12.0;
//!     let phi = (-d.cos() * t.sin()).atan2(l.cos() * d.sin() - l.sin() * d.cos() * t.cos());
//!     let slide = 180.0 + phi.to_degrees();
//!     let right = lecture(day as u32, hours, latitude).azimuth_deg;
//!     println!("{day} {hours} {latitude} {slide:.1} {right:.1} {:.1}", slide - right);
//!     assert!((slide - printed).abs() < 0.06, "{slide}");
//!     assert!((right - corrected).abs() < 0.06, "{right}");
//!     assert!((slide - right - difference).abs() < 0.11);
//!     rows += 1;
//! }
//! assert_eq!(rows, 6);
//! ```
//!
//! **Solar time.** t is solar time (12 when the sun is on the meridian), not the clock's; J is the day of the year, not the astronomers'
//! Julian date. [`solar_time`](crate::daylight::sun_position::solar_time) makes both from a moment with its UTC offset and a longitude
//! positive to the east: t = UTC + equation of time + longitude/15.
//!
//! **L_sun and E_sun.** The illumination model calls the sun's term L_sun, "radiance (color) of the directional light", but the slide "Direct
//! sunlight" sets that colour to the irradiance at normal incidence, in lux here. It is E_sun in this program, where
//! L_sun is the sun's light that a surface reflects toward the eye. The disc's luminance is
//! [`Daylight::sun_luminance`](crate::daylight::Daylight::sun_luminance), and E_sun = L Ω.
//!
//! **1383 W/m² are no lux.** They are power over all wavelengths. The 683 lm/W hold at 555 nm only: the product, 945 klux, would be 7.4
//! times the sun outside the atmosphere, which the spectrum gives as 127 klux.
//!
//! ```
//! use skylight::daylight::{colour::luminance, sunlight::{Sunlight, lecture_sun_irradiance}};
//! let lux = luminance(Sunlight::extraterrestrial().illuminance());
//! let wrong = 683.0 * lecture_sun_irradiance();
//! assert!((126e3..128e3).contains(&lux) && (7.3..7.6).contains(&(wrong / lux)), "{lux} {wrong}");
//! ```
//!
//! **Texels.** 2i/res - 1 is a texel's corner; texels here are centred at (i + ½)/N, in Vulkan's face order.
//!
//! **The frame.** 1/(1 + n_z) is infinite at n = (0, 0, -1) and inaccurate near it in 32 bits: [`tangent_frame`](crate::daylight::tangent_frame).
//!
//! **E and E/π.** The mean of L over directions of density cos θ/π estimates E/π. The irradiance map holds E.
//!
//! # `--preset lecture`
//!
//! The course framework's settings: day 200 at 10 h solar time, latitude 45°, turbidity 2.4, the lecture's sun formulas without refraction, black
//! below the horizon, sky cube 512², irradiance of 2 000 random samples as 400 frames of 5, shadow map 4096², occlusion at half resolution,
//! 55° field of view, one linear scale s = 0.025 and γ = 1. Any other option still rules.
//!
//! The preset also sets `--ambient ssao --bounces 0`: the picture is then the row "Illumination model" of the map, with A in screen
//! space, and L_e where surfaces emit, which light no others. Without the preset it is L = T (L_e + L_sun + L_sky + L_bounces) + L_air ([the first page](crate)): the same terms of the sun, the sky by its
//! true visibility instead of A, and the light that surfaces emit and reflect onto each other. From 16 samples on A is the true visibility with
//! the preset too, unless `--visibility ssao` is given.
//!
//! The framework multiplies s with the sky's RGB divided by 683, and with the sun's radiometric RGB: both are luminous values over
//! 683 lm/W. So with luminances L in cd/m² the picture is
//!
//! display = s L / 683,
//!
//! and a `--scale S` means the same here. White (display 1) is 683/0.025 = 27 320 cd/m², which is EV100 14.5:
//!
//! ```
//! use skylight::daylight::exposure::{ev100_from_factor, factor_from_ev100};
//! let factor = 0.025 / 683.0;
//! assert!((ev100_from_factor(factor) - 14.47).abs() < 0.01);
//! assert!((factor_from_ev100(14.4746) / factor - 1.0).abs() < 1e-3);
//! ```
//!
//! Not taken over: the framework's factor 0.8 on the sun's irradiance, its fade between the cosines -0.05 and -0.15 below the
//! horizon, its 16-bit running mean, and its shadow bias.
