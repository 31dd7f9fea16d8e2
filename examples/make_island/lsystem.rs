//! Lindenmayer systems and their turtle interpretation (Prusinkiewicz and Lindenmayer 1990, "The Algorithmic Beauty of Plants",
//! chapter 1).

use glam::{Quat, Vec3};

use crate::noise::Chance;

/// A grammar: an axiom, and the possible replacements of some letters.
pub struct Grammar {
    pub axiom: &'static str,
    pub rules: &'static [(char, &'static [&'static str])],
    pub steps: usize,
}

impl Grammar {
    /// The word after all derivation steps.
    pub fn derive(&self, chance: &mut Chance) -> String {
        let mut word = self.axiom.to_owned();
        for _ in 0..self.steps {
            word = word.chars().map(|c| self.replace(c, chance)).collect();
        }
        word
    }

    fn replace(&self, letter: char, chance: &mut Chance) -> String {
        let rule = self.rules.iter().find(|(from, _)| *from == letter);
        let Some((_, words)) = rule else {
            return letter.to_string();
        };
        let choice = (chance.unit() * words.len() as f32) as usize;
        words[choice.min(words.len() - 1)].to_owned()
    }
}

/// Parameters of the turtle.
#[derive(Clone, Copy)]
pub struct Walk {
    /// Length of `F`, metres; each `!` scales it by `shorter`.
    pub step: f32,
    pub shorter: f32,
    /// Turning angle and its variation, degrees.
    pub angle: f32,
    pub jitter: f32,
    /// Radius at the foot, metres; each `!` scales it by `thinner`.
    pub radius: f32,
    pub thinner: f32,
    /// How much each step bends up (down if negative).
    pub tropism: f32,
}

/// The output of the turtle.
pub struct Branch {
    pub ends: [Vec3; 2],
    pub radii: [f32; 2],
}

/// A leaf position and the direction of its twig.
pub struct Leaf {
    pub at: Vec3,
    pub along: Vec3,
}

#[derive(Clone, Copy)]
struct Turtle {
    at: Vec3,
    turn: Quat,
    step: f32,
    radius: f32,
}

/// Interprets a word: `F` forward, `+ - & ^ / \` rotations, `!` thinner and shorter, `[ ]` side branch, `L` leaves.
pub fn walk(word: &str, how: &Walk, chance: &mut Chance) -> (Vec<Branch>, Vec<Leaf>) {
    let (mut branches, mut leaves, mut saved) = (Vec::new(), Vec::new(), Vec::new());
    let mut turtle = Turtle {
        at: Vec3::ZERO,
        turn: Quat::IDENTITY,
        step: how.step,
        radius: how.radius,
    };
    for letter in word.chars() {
        let angle = (how.angle + how.jitter * chance.within(-1.0, 1.0)).to_radians();
        let turn = |axis: Vec3, angle: f32| Quat::from_axis_angle(axis, angle);
        match letter {
            'F' => branches.push(turtle.forward(how, chance)),
            'L' => leaves.push(Leaf {
                at: turtle.at,
                along: turtle.turn * Vec3::Y,
            }),
            '+' => turtle.turn *= turn(Vec3::Z, angle),
            '-' => turtle.turn *= turn(Vec3::Z, -angle),
            '&' => turtle.turn *= turn(Vec3::X, angle),
            '^' => turtle.turn *= turn(Vec3::X, -angle),
            // A random rotation about the branch axis.
            '/' => {
                turtle.turn *= turn(
                    Vec3::Y,
                    137.5f32.to_radians() + angle - how.angle.to_radians(),
                )
            }
            '!' => {
                turtle.radius *= how.thinner;
                turtle.step *= how.shorter;
            }
            '[' => saved.push(turtle),
            ']' => turtle = saved.pop().unwrap_or(turtle),
            _ => {}
        }
    }
    (branches, leaves)
}

impl Turtle {
    fn forward(&mut self, how: &Walk, chance: &mut Chance) -> Branch {
        let along = self.turn * Vec3::Y;
        let wanted = (along + Vec3::Y * how.tropism).normalize_or(along);
        self.turn = Quat::from_rotation_arc(along, wanted) * self.turn;
        let from = (self.at, self.radius);
        self.at += self.turn * Vec3::Y * self.step * chance.within(0.85, 1.15);
        self.radius *= 0.93;
        Branch {
            ends: [from.0, self.at],
            radii: [from.1, self.radius],
        }
    }
}
