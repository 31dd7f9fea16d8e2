//! Formats of windows: which of the pairs of format and colour space that a surface offers is taken, and how a picture is encoded for it.

use ash::vk;

use vk::{ColorSpaceKHR as Space, Format};

/// How values are written to a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Linear values, 0..=1; the format itself encodes them by the sRGB curve.
    ByFormat,
    /// The shader encodes by the sRGB curve (IEC 61966-2-1), 0..=1.
    Srgb,
    /// scRGB (IEC 61966-2-2): linear BT.709, 1 is 80 cd/m².
    ScRgb,
    /// HDR10: BT.2020 by the PQ curve (SMPTE ST 2084), 1 is 10 000 cd/m².
    Hdr10,
}

impl Encoding {
    /// Whether the screen shows more than the white of paper.
    pub fn is_hdr(self) -> bool {
        matches!(self, Self::ScRgb | Self::Hdr10)
    }
}

/// What a window is drawn in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Output {
    /// Format of the window's images.
    pub format: Format,
    /// How values are encoded for it.
    pub encoding: Encoding,
    pub(in crate::gpu) color_space: Space,
}

impl Output {
    /// Images of a `format` with values encoded so, in the colour space that belongs to the encoding.
    pub fn new(format: Format, encoding: Encoding) -> Self {
        let color_space = match encoding {
            Encoding::ByFormat | Encoding::Srgb => Space::SRGB_NONLINEAR,
            Encoding::ScRgb => Space::EXTENDED_SRGB_LINEAR_EXT,
            Encoding::Hdr10 => Space::HDR10_ST2084_EXT,
        };
        Self {
            format,
            encoding,
            color_space,
        }
    }
}

/// What the pictures of an HDR window hold at most, for the screen to fit them to itself (SMPTE ST 2086, CTA-861.3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Content {
    /// Chromaticities (x, y) of red, green and blue: no colour lies outside.
    pub primaries: [[f64; 2]; 3],
    /// Chromaticity of white.
    pub white: [f64; 2],
    /// Luminance of the brightest pixel, cd/m².
    pub peak: f64,
}

impl Content {
    /// As Vulkan takes it. The mean luminance of a picture is not known ahead: 0 says so.
    pub(in crate::gpu) fn metadata(&self) -> vk::HdrMetadataEXT<'static> {
        let chromaticity = |[x, y]: [f64; 2]| vk::XYColorEXT {
            x: x as f32,
            y: y as f32,
        };
        let [red, green, blue] = self.primaries.map(chromaticity);
        vk::HdrMetadataEXT::default()
            .display_primary_red(red)
            .display_primary_green(green)
            .display_primary_blue(blue)
            .white_point(chromaticity(self.white))
            .max_luminance(self.peak as f32)
            .min_luminance(0.0)
            .max_content_light_level(self.peak as f32)
            .max_frame_average_light_level(0.0)
    }
}

/// What the program can draw to, best first. Of HDR signals HDR10 comes first: its values are luminances, whatever the system.
const KNOWN: [(Encoding, &[Format]); 4] = [
    (
        Encoding::Hdr10,
        &[
            Format::A2B10G10R10_UNORM_PACK32,
            Format::A2R10G10B10_UNORM_PACK32,
            Format::R16G16B16A16_UNORM,
        ],
    ),
    (Encoding::ScRgb, &[Format::R16G16B16A16_SFLOAT]),
    (
        Encoding::ByFormat,
        &[
            Format::B8G8R8A8_SRGB,
            Format::R8G8B8A8_SRGB,
            Format::A8B8G8R8_SRGB_PACK32,
        ],
    ),
    (
        Encoding::Srgb,
        &[
            Format::B8G8R8A8_UNORM,
            Format::R8G8B8A8_UNORM,
            Format::A8B8G8R8_UNORM_PACK32,
            Format::A2B10G10R10_UNORM_PACK32,
            Format::A2R10G10B10_UNORM_PACK32,
            Format::R16G16B16A16_UNORM,
            Format::R16G16B16A16_SFLOAT,
        ],
    ),
];

/// The best output among what a surface offers; one for an HDR screen only if `hdr` and offered. `None` if the program can draw to none.
pub(in crate::gpu) fn choose(offered: &[vk::SurfaceFormatKHR], hdr: bool) -> Option<Output> {
    let known = KNOWN.iter().filter(|known| hdr || !known.0.is_hdr());
    known
        .flat_map(|(encoding, formats)| formats.iter().map(|f| Output::new(*f, *encoding)))
        .find(|output| {
            offered
                .iter()
                .any(|o| o.format == output.format && o.color_space == output.color_space)
        })
}

/// What a surface offers, for a message: formats with their colour spaces.
pub(in crate::gpu) fn listed(offered: &[vk::SurfaceFormatKHR]) -> String {
    let each = offered
        .iter()
        .map(|o| format!("{:?} {:?}", o.format, o.color_space));
    each.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A list of formats in a colour space.
    fn offer(list: &[(Format, Space)]) -> Vec<vk::SurfaceFormatKHR> {
        let each = list.iter().map(|(format, color_space)| {
            vk::SurfaceFormatKHR::default()
                .format(*format)
                .color_space(*color_space)
        });
        each.collect()
    }

    const SDR: Space = Space::SRGB_NONLINEAR;
    const UNORM: (Format, Space) = (Format::B8G8R8A8_UNORM, SDR);
    const SRGB: (Format, Space) = (Format::B8G8R8A8_SRGB, SDR);
    const TEN_BITS: (Format, Space) = (Format::A2R10G10B10_UNORM_PACK32, SDR);
    const SCRGB: (Format, Space) = (Format::R16G16B16A16_SFLOAT, Space::EXTENDED_SRGB_LINEAR_EXT);
    const HDR10: (Format, Space) = (Format::A2B10G10R10_UNORM_PACK32, Space::HDR10_ST2084_EXT);

    type Row<'a> = (
        &'a str,
        &'a [(Format, Space)],
        Option<((Format, Space), Encoding)>,
        Option<((Format, Space), Encoding)>,
    );

    #[test]
    fn the_best_output_of_each_desktop() {
        let by_format = Some((SRGB, Encoding::ByFormat));
        let table: [Row<'_>; 8] = [
            ("X11, 24 bits", &[SRGB, UNORM], by_format, by_format),
            ("the other order", &[UNORM, SRGB], by_format, by_format),
            (
                "UNORM alone",
                &[UNORM],
                Some((UNORM, Encoding::Srgb)),
                Some((UNORM, Encoding::Srgb)),
            ),
            (
                "X11, 30 bits",
                &[TEN_BITS],
                Some((TEN_BITS, Encoding::Srgb)),
                Some((TEN_BITS, Encoding::Srgb)),
            ),
            (
                "a desktop in HDR",
                &[UNORM, SRGB, SCRGB, HDR10],
                by_format,
                Some((HDR10, Encoding::Hdr10)),
            ),
            (
                "one with scRGB alone",
                &[SCRGB, TEN_BITS, SRGB],
                by_format,
                Some((SCRGB, Encoding::ScRgb)),
            ),
            (
                "colour spaces that mean something else",
                &[
                    (Format::R16G16B16A16_SFLOAT, Space::DISPLAY_P3_LINEAR_EXT),
                    (Format::A2B10G10R10_UNORM_PACK32, Space::HDR10_HLG_EXT),
                ],
                None,
                None,
            ),
            ("nothing", &[], None, None),
        ];
        for (name, offered, sdr, hdr) in table {
            for (wanted, expected) in [(false, sdr), (true, hdr)] {
                let found = choose(&offer(offered), wanted);
                let found = found.map(|o| ((o.format, o.color_space), o.encoding));
                assert_eq!(found, expected, "{name}, {wanted}");
            }
        }
    }

    #[test]
    fn without_an_hdr_signal_the_same_is_taken_and_a_message_names_what_there_is() {
        let offered = offer(&[UNORM, TEN_BITS]);
        let found = choose(&offered, true);
        assert_eq!(found, choose(&offered, false));
        assert!(found.is_some_and(|output| !output.encoding.is_hdr()));
        assert!(listed(&offered).starts_with("B8G8R8A8_UNORM SRGB_NONLINEAR, "));
    }
}
