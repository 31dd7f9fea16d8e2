//! A drawing as SVG 1.1.

use std::fmt::Write as _;

use super::{Anchor, Drawing, Fill, Part, Shape, Stroke, Text};

/// Fonts of plain letters; the last is of the reader's machine.
const FONTS: &str = "Helvetica, Arial, 'DejaVu Sans', sans-serif";

/// Text for an element or an attribute.
pub(crate) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            // Not allowed in XML.
            c if c.is_control() => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

/// Hundredths of a pixel, without digits that say nothing.
fn number(value: f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    // Not "-0".
    (rounded + 0.0).to_string()
}

impl Drawing {
    /// The drawing as one element, to stand alone or in a page.
    pub fn svg(&self) -> String {
        let [width, height] = self.size.map(number);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\">\n<title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
            escaped(&self.title)
        );
        for part in &self.parts {
            match part {
                Part::Fill(fill) => add_fill(&mut svg, fill),
                Part::Stroke(stroke) => add_stroke(&mut svg, stroke),
                Part::Shape(shape) => add_shape(&mut svg, shape),
                Part::Text(text) => add_text(&mut svg, text),
            }
        }
        svg + "</svg>\n"
    }
}

fn add_fill(svg: &mut String, fill: &Fill) {
    let (class, ink) = (fill.name, fill.ink);
    let _ = write!(
        svg,
        "<path class=\"{class}\" fill=\"{ink}\" shape-rendering=\"crispEdges\" d=\""
    );
    for area in &fill.areas {
        let [x, y, width, height] = area.map(number);
        let _ = write!(svg, "M{x} {y}h{width}v{height}h-{width}z");
    }
    let _ = writeln!(svg, "\"{}", end(&fill.title, "path"));
}

/// The end of an element, with a title if it has one.
fn end(title: &str, element: &str) -> String {
    if title.is_empty() {
        return "/>".to_owned();
    }
    format!("><title>{}</title></{element}>", escaped(title))
}

fn add_stroke(svg: &mut String, stroke: &Stroke) {
    let dash = if stroke.dash > 0.0 {
        format!(" stroke-dasharray=\"{}\"", number(stroke.dash))
    } else {
        String::new()
    };
    let _ = write!(
        svg,
        "<path class=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" stroke-linejoin=\"round\"{dash} d=\"",
        stroke.name,
        stroke.ink,
        number(stroke.width)
    );
    for run in &stroke.runs {
        for (at, [x, y]) in run.iter().enumerate() {
            let letter = if at == 0 { 'M' } else { 'L' };
            let _ = write!(svg, "{letter}{} {}", number(*x), number(*y));
        }
    }
    svg.push_str("\"/>\n");
}

fn add_shape(svg: &mut String, shape: &Shape) {
    let corners: Vec<String> = shape
        .corners
        .iter()
        .map(|[x, y]| format!("{},{}", number(*x), number(*y)))
        .collect();
    // The thin rim closes the seams that viewers leave between neighbours.
    let ink = shape.ink;
    let _ = writeln!(
        svg,
        "<polygon class=\"{}\" fill=\"{ink}\" stroke=\"{ink}\" stroke-width=\"0.4\" shape-rendering=\"crispEdges\" points=\"{}\"{}",
        shape.name,
        corners.join(" "),
        end(&shape.title, "polygon")
    );
}

fn add_text(svg: &mut String, text: &Text) {
    let anchor = match text.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let rim = if text.is_rimmed {
        " stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\""
    } else {
        ""
    };
    let [x, y] = text.at.map(number);
    let _ = writeln!(
        svg,
        "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{}\"{rim}>{}</text>",
        text.size.pixels(),
        text.ink,
        escaped(&text.words)
    );
}

#[cfg(test)]
mod tests {
    use super::super::{Ink, Size};
    use super::*;

    #[test]
    fn a_drawing_is_well_formed_and_keeps_its_words_and_colours() {
        let mut drawing = Drawing::new([40.0, 30.5], "a < b & \"c\"".to_owned());
        drawing.text(
            [1.0, -0.001],
            Anchor::End,
            Size::Large,
            "5 m² < \u{1} 6 & 7",
        );
        drawing.line(vec![[0.0, 1.0], [2.0, 1.0 / 3.0]], Ink([1, 2, 255]), 2.0);
        drawing.parts.push(Part::Fill(Fill {
            areas: vec![[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 1.0, 1.0]],
            ink: Ink([16, 0, 0]),
            title: "d > e".to_owned(),
            name: "cell",
        }));
        let svg = drawing.svg();
        let xml = roxmltree::Document::parse(&svg).expect("XML");
        let of = |name: &str| {
            xml.descendants()
                .filter(|n| n.has_tag_name(name))
                .collect::<Vec<_>>()
        };
        assert_eq!(of("title")[0].text(), Some("a < b & \"c\""));
        let text = of("text")[0];
        assert_eq!(text.text(), Some("5 m² <   6 & 7"));
        assert_eq!(
            [text.attribute("y"), text.attribute("text-anchor")],
            [Some("0"), Some("end")]
        );
        let paths = of("path");
        assert_eq!(paths[0].attribute("d"), Some("M0 1L2 0.33"));
        assert_eq!(paths[0].attribute("stroke"), Some("#0102ff"));
        assert_eq!(paths[1].attribute("d"), Some("M1 2h3v4h-3zM5 6h1v1h-1z"));
        assert_eq!(paths[1].attribute("fill"), Some("#100000"));
        assert_eq!(
            paths[1].first_element_child().and_then(|t| t.text()),
            Some("d > e")
        );
    }
}
