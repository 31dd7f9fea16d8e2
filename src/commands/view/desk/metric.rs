//! What the desk shows at the sensors.

use crate::options::choice_enum;

choice_enum! {
    /// A quantity at sensors.
    #[derive(Default)]
    pub enum Metric {
        #[default]
        Now = "now": "Illuminance in the light that is shown",
        Df = "df": "Daylight factor under the overcast sky of the CIE",
        Da = "da": "Daylight autonomy: occupied hours, 8 to 18 every day, with at least 300 lux",
        Cda = "cda": "Continuous daylight autonomy: hours below 300 lux count in part",
        Udi = "udi": "Useful daylight illuminance: occupied hours from 300 to 3 000 lux",
        Ase = "ase": "Occupied hours with more than 1 000 lux of direct sun",
        Mean = "illuminance": "Mean illuminance of all hours of the year",
    }
}

choice_enum! {
    /// A standard whose verdict is shown.
    #[derive(Default)]
    pub enum Standard {
        #[default]
        En17037 = "EN 17037": "EN 17037:2018, 5.1: daylight provision by both methods",
        Lm83 = "LM-83": "IES LM-83-12 with the limits of LEED v4.1: sDA and ASE",
    }
}

impl Metric {
    /// Whether it takes the hours of a weather file.
    pub fn needs_hours(self) -> bool {
        !matches!(self, Self::Now | Self::Df)
    }

    /// Its column in the results of `skylight daylight`.
    pub fn column(self) -> &'static str {
        match self {
            Self::Now => "total_lux",
            Self::Df => "df",
            Self::Da => "da300",
            Self::Cda => "cda300",
            Self::Udi => "udi_aut",
            Self::Ase => "ase_hours",
            Self::Mean => "mean_lux",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Now | Self::Mean => "lux",
            Self::Ase => "h",
            _ => "%",
        }
    }
}
