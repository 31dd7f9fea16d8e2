//! Numbers of materials: one for all, or by name.

use std::fmt;

use super::values::number;
use crate::daylight::glass::clearest;

/// Numbers of materials in the order given, each with the name of its material; the name is empty where the number is for all.
#[derive(Debug, Clone, PartialEq)]
pub struct ByMaterial(pub Vec<(String, f64)>);

/// In the form that the parsers read.
impl fmt::Display for ByMaterial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, (name, value)) in self.0.iter().enumerate() {
            let comma = if at > 0 { "," } else { "" };
            let equals = if name.is_empty() { "" } else { "=" };
            write!(f, "{comma}{name}{equals}{value}")?;
        }
        Ok(())
    }
}

/// `T`, or `NAME=T,NAME=T`: transmittances of panes at normal incidence.
pub(super) fn glass(text: &str) -> Result<ByMaterial, String> {
    let form = "write a transmittance, for instance 0.7, or MATERIAL=0.7,MATERIAL=0.5";
    let list = by_material(text, form)?;
    if list.0.len() > 1 && list.0.iter().any(|(name, _)| name.is_empty()) {
        return Err(form.to_owned());
    }
    let most = clearest();
    match list.0.iter().find(|(_, v)| *v < 0.01 || *v > most) {
        Some((_, value)) => Err(format!(
            "a pane of clear glass lets 0.01 to {most:.3} of the light through, not {value}"
        )),
        None => Ok(list),
    }
}

/// `NAME=R,NAME=R`: reflectances.
pub(super) fn reflectance(text: &str) -> Result<ByMaterial, String> {
    let form = "write MATERIAL=0.7, or MATERIAL=0.7,MATERIAL=0.5";
    let list = by_material(text, form)?;
    if list.0.iter().any(|(name, _)| name.is_empty()) {
        return Err(form.to_owned());
    }
    match list.0.iter().find(|(_, v)| !(0.0..=1.0).contains(v)) {
        Some((name, value)) => Err(format!(
            "the reflectance of \"{name}\" must be 0 to 1, not {value}"
        )),
        None => Ok(list),
    }
}

fn by_material(text: &str, form: &str) -> Result<ByMaterial, String> {
    let mut list: Vec<(String, f64)> = Vec::new();
    for part in text.split(',') {
        // A name may hold the sign, a number does not.
        let (name, value) = part.rsplit_once('=').unwrap_or(("", part));
        let name = name.trim().to_owned();
        if part.contains('=') && name.is_empty() {
            return Err(form.to_owned());
        }
        if list.iter().any(|(known, _)| *known == name) {
            return Err(format!("\"{name}\" is given twice; leave one out"));
        }
        list.push((name, number(value)?));
    }
    Ok(ByMaterial(list))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_for_all_or_by_name() {
        let list = |list: &[(&str, f64)]| {
            let owned = |(name, value): &(&str, f64)| ((*name).to_owned(), *value);
            ByMaterial(list.iter().map(owned).collect())
        };
        assert_eq!(glass("0.7"), Ok(list(&[("", 0.7)])));
        let two = glass("Clear=6mm=0.7, roof=.5").expect("two");
        assert_eq!(two, list(&[("Clear=6mm", 0.7), ("roof", 0.5)]));
        assert_eq!(glass(&two.to_string()), Ok(two));
        assert_eq!(
            reflectance("floor=1").map(|l| l.to_string()),
            Ok("floor=1".to_owned())
        );
    }

    #[test]
    fn what_is_no_number_of_a_material_is_refused() {
        for (text, part) in [
            ("0.95", "0.918"),
            ("0", "0.01 to"),
            ("a=0.5,0.7", "for instance"),
            ("a=0.5,a=0.7", "\"a\" is given twice"),
            ("=0.5", "for instance"),
            ("clear", "not a number"),
        ] {
            let error = glass(text).expect_err(text);
            assert!(error.contains(part), "{text}: {error}");
        }
        for (text, part) in [
            ("0.5", "MATERIAL=0.7"),
            ("floor=1.2", "reflectance of \"floor\""),
            ("floor=", "not a number"),
        ] {
            let error = reflectance(text).expect_err(text);
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
