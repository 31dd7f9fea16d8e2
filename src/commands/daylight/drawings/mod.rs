//! Pictures of results: a metric over its plane, a year hour by day.

mod contours;
mod heat;
mod panel;
mod plan;
mod scale;
mod words;

pub(super) use self::heat::{Heat, hours};
pub(super) use self::plan::Plan;
#[cfg(feature = "window")]
pub(in crate::commands) use self::scale::Scale;
#[cfg(feature = "window")]
pub(in crate::commands) use self::words::is_share;
pub(super) use self::words::{heading, limit};
