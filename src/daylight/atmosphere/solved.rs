//! The tables of the airs that were asked for last: solving one costs as much as some ten frames.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::Atmosphere;
use super::air::Air;

/// Airs whose tables are kept.
const KEPT: usize = 4;

static SOLVED: Solved = Solved(Mutex::new(Vec::new()));

impl Atmosphere {
    /// Like [`Atmosphere::new`], with the tables of the last airs that were asked for if it is one of them. Waits if another thread
    /// is solving this air.
    pub fn of(air: &Air) -> Self {
        SOLVED.of(air)
    }

    /// Whether [`Atmosphere::of`] returns at once.
    pub fn is_solved(air: &Air) -> bool {
        SOLVED.holds(air)
    }
}

/// An air at sea level and its tables, once a thread has solved them.
struct Entry {
    air: Air,
    tables: Arc<OnceLock<Atmosphere>>,
}

/// The newest first.
struct Solved(Mutex<Vec<Entry>>);

impl Solved {
    fn of(&self, air: &Air) -> Atmosphere {
        let (air, _) = air.clamped();
        let at_sea_level = at_sea_level(air);
        // Locked for the search alone: who asks for a solved air does not wait for another one.
        let tables = self.entry(at_sea_level);
        let found = tables.get_or_init(|| Atmosphere::new(&at_sea_level));
        Atmosphere {
            air,
            ..found.clone()
        }
    }

    fn holds(&self, air: &Air) -> bool {
        let air = at_sea_level(air.clamped().0);
        // A thread that panicked left the list whole.
        let entries = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut entries = entries.iter();
        entries.any(|entry| entry.air == air && entry.tables.get().is_some())
    }

    /// The tables of `air`, now the newest, solved or not.
    fn entry(&self, air: Air) -> Arc<OnceLock<Atmosphere>> {
        let mut entries = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let new = || Entry {
            air,
            tables: Arc::default(),
        };
        let known = entries.iter().position(|entry| entry.air == air);
        let found = known.map_or_else(new, |i| entries.remove(i));
        let tables = Arc::clone(&found.tables);
        entries.truncate(KEPT - 1);
        entries.insert(0, found);
        tables
    }
}

/// The observer's altitude changes no table.
fn at_sea_level(air: Air) -> Air {
    Air {
        altitude_m: 0.0,
        ..air
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    #[test]
    fn an_air_is_solved_once_for_all_altitudes_and_threads() {
        let solved = &Solved(Mutex::default());
        let [low, high] = [0.0, 1500.0].map(|altitude_m| Air {
            altitude_m,
            ..Air::default()
        });
        assert!(!solved.holds(&low));
        let [a, b] = thread::scope(|scope| {
            [low, high]
                .map(|air| scope.spawn(move || solved.of(&air)))
                .map(|thread| thread.join().expect("solved"))
        });
        assert!(Arc::ptr_eq(&a.field, &b.field));
        assert_eq!([a.air, b.air], [low, high]);
        assert!(solved.holds(&low) && solved.holds(&high));
    }

    #[test]
    fn the_oldest_air_goes_first() {
        let solved = Solved(Mutex::default());
        let airs = [0.0, 0.1, 0.2, 0.3, 0.4].map(|aod| Air {
            aod,
            ..Air::default()
        });
        // The tables are not looked at.
        let known = |air: Air| {
            solved
                .0
                .lock()
                .expect("whole")
                .iter()
                .any(|entry| entry.air == air)
        };
        for air in [airs[0], airs[1], airs[2], airs[3], airs[0], airs[4]] {
            solved.entry(air);
        }
        assert_eq!(airs.map(known), [true, false, true, true, true]);
    }
}
