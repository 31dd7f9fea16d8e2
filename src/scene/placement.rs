//! How the coordinates of a model become those of the world: its unit, the axis that points up, and where a scene file puts it.

use glam::{DAffine3, DMat3, DVec3};

/// The axis of a model that points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Up {
    /// +Y, as in glTF and in this program.
    #[default]
    Y,
    /// +Z: +Y of the model becomes north.
    Z,
}

/// The unit of length of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Millimetre.
    Mm,
    /// Centimetre.
    Cm,
    /// Metre.
    M,
    /// Inch, 25.4 mm.
    In,
    /// Foot, 304.8 mm.
    Ft,
}

impl Unit {
    /// Metres.
    pub fn metres(self) -> f64 {
        match self {
            Self::Mm => 0.001,
            Self::Cm => 0.01,
            Self::M => 1.0,
            Self::In => 0.0254,
            Self::Ft => 0.3048,
        }
    }
}

/// Placement of a mesh in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placement {
    pub world_from_mesh: DAffine3,
    /// Crease angle below which corners without a normal are smoothed, degrees.
    pub smooth_deg: Option<f32>,
}

/// The transform of a model in a unit with an axis up to the world, metres and +Y up.
pub(super) fn upright(up: Up, unit: Unit) -> DAffine3 {
    let axes = match up {
        Up::Y => DMat3::IDENTITY,
        Up::Z => DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
    };
    DAffine3::from_mat3(axes * unit.metres())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn z_up_makes_north_of_y() {
        let world = |p| upright(Up::Z, Unit::Cm).transform_point3(p);
        assert_eq!(world(DVec3::Z * 100.0), DVec3::Y);
        assert_eq!(world(DVec3::Y * 100.0), DVec3::NEG_Z);
        assert_eq!(upright(Up::Y, Unit::M), DAffine3::IDENTITY);
    }
}
