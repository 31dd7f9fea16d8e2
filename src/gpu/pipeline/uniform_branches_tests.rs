//! No branch or loop of the passes of the cells hangs on uniforms and push constants alone: lavapipe compiles a shader anew for each of their
//! values, in the midst of a frame.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::shader::{BindingKind, Shader, Stage, compiled};

/// Members that change with the options alone: what hangs on them is compiled once.
const STEADY: [&str; 2] = ["segments", "ends_in_cell"];

/// What a value depends on: members of uniform blocks and push constants, none for a constant. `None`: on more than these.
type Origin = Option<BTreeSet<String>>;

// Opcodes of SPIR-V 1.6, 3.52, and storage classes, 3.7.
const EXT_INST: u32 = 12;
const CONSTANT: u32 = 43;
const VARIABLE: u32 = 59;
const LOAD: u32 = 61;
const CHAINS: [u32; 2] = [65, 66];
const DECORATE: u32 = 71;
const SHUFFLE: u32 = 79;
const EXTRACT: u32 = 81;
const INSERT: u32 = 82;
const PHI: u32 = 245;
const LOOP_MERGE: u32 = 246;
const LABEL: u32 = 248;
const BRANCH_CONDITIONAL: u32 = 250;
const SWITCH: u32 = 251;
const UNIFORM: u32 = 2;
const PUSH_CONSTANT: u32 = 9;
const BINDING: u32 = 33;

/// Constants and constants of specialization.
fn is_constant(code: u32) -> bool {
    matches!(code, 1 | 41..=52)
}

/// Instructions whose result depends on their operands alone: composites, conversions, arithmetic, comparisons, bits.
fn is_pure(code: u32) -> bool {
    matches!(code, EXT_INST | 77..=84 | 109..=152 | 154..=205)
}

/// Instructions whose results [`Origins`] tells.
fn is_followed(code: u32) -> bool {
    is_constant(code) || is_pure(code) || CHAINS.contains(&code) || [LOAD, PHI].contains(&code)
}

/// The instructions of a module, after a header of five words.
fn instructions(words: &[u32]) -> Vec<&[u32]> {
    let (mut list, mut rest) = (Vec::new(), &words[5..]);
    while let Some(first) = rest.first() {
        let (instruction, after) = rest.split_at((first >> 16).max(1) as usize);
        list.push(instruction);
        rest = after;
    }
    list
}

fn code(instruction: &[u32]) -> u32 {
    instruction[0] & 0xffff
}

/// The operands of a pure instruction that are values.
fn values(instruction: &[u32]) -> &[u32] {
    match code(instruction) {
        EXT_INST => &instruction[5..],
        EXTRACT => &instruction[3..4],
        SHUFFLE | INSERT => &instruction[3..5],
        _ => &instruction[3..],
    }
}

/// A shader, and what its values depend on as far as that is known.
struct Origins<'s> {
    shader: &'s Shader,
    instructions: Vec<&'s [u32]>,
    constants: HashMap<u32, u32>,
    bindings: HashMap<u32, u32>,
    /// Storage classes of variables.
    variables: HashMap<u32, u32>,
    /// Values that come later in the text than their first use: what the next turn of a loop begins with.
    counters: HashSet<u32>,
    known: HashMap<u32, Origin>,
}

impl<'s> Origins<'s> {
    fn of(shader: &'s Shader) -> Self {
        let instructions = instructions(shader.words);
        let of_code = |wanted: u32| instructions.iter().filter(move |i| code(i) == wanted);
        let followed: HashSet<u32> = instructions
            .iter()
            .filter(|i| is_followed(code(i)))
            .map(|i| i[2])
            .collect();
        let mut origins = Self {
            shader,
            constants: of_code(CONSTANT).map(|i| (i[2], i[3])).collect(),
            bindings: of_code(DECORATE)
                .filter(|i| i[2] == BINDING)
                .map(|i| (i[1], i[3]))
                .collect(),
            variables: of_code(VARIABLE).map(|i| (i[2], i[3])).collect(),
            counters: of_code(PHI)
                .flat_map(|i| i[3..].iter().step_by(2))
                .filter(|value| followed.contains(value))
                .copied()
                .collect(),
            known: HashMap::new(),
            instructions: instructions.clone(),
        };
        // From nothing known until nothing is new: the counter of a loop depends on itself.
        while origins.pass() {}
        origins
    }

    /// Goes through all instructions once. Whether something was new.
    fn pass(&mut self) -> bool {
        let (mut is_new, mut in_loop_header) = (false, false);
        for i in 0..self.instructions.len() {
            let instruction = self.instructions[i];
            if code(instruction) == LABEL {
                let block = self.instructions[i + 1..].iter();
                let mut block = block.take_while(|next| code(next) != LABEL);
                in_loop_header = block.any(|next| code(next) == LOOP_MERGE);
            }
            let Some(origin) = self.result(instruction, in_loop_header) else {
                continue;
            };
            let old = self.known.insert(instruction[2], origin.clone());
            is_new |= old != Some(origin);
        }
        is_new
    }

    /// The origin of an instruction's result. `None` for those without one, and for those whose result depends on more.
    fn result(&self, instruction: &[u32], in_loop_header: bool) -> Option<Origin> {
        let found = match code(instruction) {
            constant if is_constant(constant) => Some(BTreeSet::new()),
            LOAD => self.known.get(&instruction[3]).cloned().flatten(),
            chain if CHAINS.contains(&chain) => self.member(instruction),
            // Elsewhere the branch that was taken decides.
            PHI if in_loop_header => self.union(instruction[3..].iter().step_by(2)),
            PHI => None,
            pure if is_pure(pure) => self.union(values(instruction).iter()),
            _ => return None,
        };
        Some(found)
    }

    /// Of several values; those that will be known add nothing yet.
    fn union<'v>(&self, values: impl Iterator<Item = &'v u32>) -> Origin {
        let mut all = BTreeSet::new();
        for value in values {
            match self.known.get(value) {
                Some(members) => all.extend(members.as_ref()?.iter().cloned()),
                None if self.counters.contains(value) => {}
                None => return None,
            }
        }
        Some(all)
    }

    /// The member of a block that a chain leads to, if it is one of uniforms or push constants, and what its further indices depend on.
    fn member(&self, chain: &[u32]) -> Origin {
        let [_, _, _, base, index, further @ ..] = chain else {
            return None;
        };
        let fields = match *self.variables.get(base)? {
            PUSH_CONSTANT => self.shader.push?,
            UNIFORM => {
                let number = self.bindings.get(base)?;
                let is_it = |b: &&super::Binding| {
                    b.binding == *number && b.kind == BindingKind::UniformBuffer
                };
                self.shader.bindings.iter().find(is_it)?.fields
            }
            _ => return None,
        };
        let field = &fields[*self.constants.get(index)? as usize];
        let mut all = self.union(further.iter())?;
        all.insert(field.name.to_owned());
        Some(all)
    }

    /// The members that alone decide a branch, apart from the steady ones.
    fn deciding(&self) -> Vec<String> {
        let branches = self
            .instructions
            .iter()
            .filter(|i| matches!(code(i), BRANCH_CONDITIONAL | SWITCH));
        let origins = branches.filter_map(|branch| self.known.get(&branch[1])?.as_ref());
        let all: BTreeSet<&String> = origins.flatten().collect();
        let changing = all.into_iter().filter(|m| !STEADY.contains(&m.as_str()));
        changing.cloned().collect()
    }
}

#[test]
fn no_branch_of_the_cells_hangs_on_uniforms_alone() {
    let is_of_cells = |s: &&&Shader| s.stage == Stage::Compute && s.name.contains("cells_");
    let shaders: Vec<_> = compiled::ALL.iter().filter(is_of_cells).collect();
    assert!(shaders.len() >= 5);
    let found: Vec<String> = shaders
        .iter()
        .map(|shader| (shader.name, Origins::of(shader).deciding()))
        .filter(|(_, members)| !members.is_empty())
        .map(|(name, members)| format!("{name}: {}", members.join(", ")))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Shaders that do have such branches.
#[test]
fn branches_on_uniforms_are_found() {
    let of = |shader| Origins::of(shader).deciding();
    let irradiance = of(&compiled::IRRADIANCE_COMP);
    assert!(irradiance.contains(&"count".to_owned()), "{irradiance:?}");
}
