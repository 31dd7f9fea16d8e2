//! What the columns of a result are called in drawings and reports.

use crate::daylight::metrics::{EXPOSED_HOURS, SPATIAL_LUX, SPATIAL_PERCENT};

/// Vertical sky component that a window should have, percent (Littlefair 2022, BR 209, 2.2.7).
const SKY_COMPONENT: f64 = 27.0;

/// What a column holds.
pub fn heading(name: &str) -> String {
    let after = |prefix: &str| name.strip_prefix(prefix).map(str::to_owned);
    if let Some(lux) = after("cda") {
        return format!("Continuous daylight autonomy, {lux} lux");
    }
    if let Some(lux) = after("da") {
        return format!("Daylight autonomy: occupied hours with at least {lux} lux");
    }
    if let Some(lux) = after("en17037_hours_ge") {
        return format!("EN 17037: daylight hours with at least {lux} lux");
    }
    if let Some(date) = after("sun_hours_") {
        return format!("Hours of sun without clouds, {date}");
    }
    let known = match name {
        "udi_low" => "Useful daylight illuminance: hours below 100 lux",
        "udi_sup" => "Useful daylight illuminance: hours from 100 to below 300 lux",
        "udi_aut" => "Useful daylight illuminance: hours from 300 to 3 000 lux",
        "udi_high" => "Useful daylight illuminance: hours above 3 000 lux",
        "ase_hours" => "Direct sun: occupied hours with more than 1 000 lux of it",
        "df" => "Daylight factor under the overcast sky of the CIE",
        "vsc" => "Sky component under the overcast sky of the CIE",
        "mean_lux" => "Mean illuminance of all hours",
        "total_lux" => "Illuminance",
        other => other,
    };
    known.to_owned()
}

/// The value at which a standard parts good from bad, and whose it is.
pub fn limit(name: &str, en17037_hours: f64) -> Option<(f64, &'static str)> {
    if name == format!("da{SPATIAL_LUX}") {
        return Some((SPATIAL_PERCENT, "IES LM-83"));
    }
    if name.starts_with("en17037_hours") {
        return Some((en17037_hours, "EN 17037"));
    }
    match name {
        "ase_hours" => Some((EXPOSED_HOURS, "IES LM-83")),
        "vsc" => Some((SKY_COMPONENT, "BR 209")),
        _ => None,
    }
}

/// Whether a column is a share of hours, whose scale ends at 100 %.
pub fn is_share(name: &str) -> bool {
    ["da", "cda", "udi"]
        .iter()
        .any(|kind| name.starts_with(kind))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_names_and_limits() {
        assert!(heading("cda500").contains("500 lux"));
        assert!(heading("da300").contains("at least 300 lux"));
        assert_eq!(limit("da300", 2190.0), Some((50.0, "IES LM-83")));
        assert_eq!(limit("da500", 2190.0), None);
        assert_eq!(
            limit("en17037_hours_ge500", 2190.0),
            Some((2190.0, "EN 17037"))
        );
        assert!(is_share("udi_aut") && !is_share("df") && !is_share("ase_hours"));
    }
}
