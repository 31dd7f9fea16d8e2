//! A part of a job that one of several machines does.

use std::str::FromStr;

/// Most shards of a job.
pub const MOST_SHARDS: u32 = 100_000;

/// One of the equal parts of a job, which has units with numbers from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Its number, 1..=`of`.
    pub number: u32,
    /// How many there are.
    pub of: u32,
}

impl Shard {
    /// The whole job.
    pub const ALL: Self = Self { number: 1, of: 1 };

    /// Whether a unit is in this shard: units are dealt like cards, so that neighbours, which cost alike, are spread.
    pub fn takes(self, unit: usize) -> bool {
        unit % self.of as usize == self.number as usize - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    /// `3/12`.
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text
            .split_once('/')
            .map(|(number, of)| (number.parse(), of.parse()));
        match numbers {
            Some((Ok(number), Ok(of))) if (1..=of).contains(&number) && of <= MOST_SHARDS => {
                Ok(Self { number, of })
            }
            _ => Err(format!(
                "write the number of a shard and how many there are, for instance 1/12; {MOST_SHARDS} at most"
            )),
        }
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_in_one_shard() {
        for of in [1, 2, 7, 12] {
            let shards = (1..=of).map(|number| Shard { number, of });
            let mut times = [0; 50];
            for shard in shards {
                let taken = (0..50).filter(|unit| shard.takes(*unit));
                taken.for_each(|unit| times[unit] += 1);
            }
            assert_eq!(times, [1; 50], "{of}");
        }
    }

    #[test]
    fn shards_are_read() {
        assert_eq!("3/12".parse(), Ok(Shard { number: 3, of: 12 }));
        for text in [
            "", "3", "0/12", "13/12", "1/0", "a/b", "1/2/3", "-1/2", "1/999999",
        ] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
