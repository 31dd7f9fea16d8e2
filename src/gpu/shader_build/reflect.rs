//! Reflection of a stage's interface from its SPIR-V.

use std::collections::HashMap;
use std::fmt::Write as _;

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, ExecutionMode, Op, StorageClass, Word};

/// The fields `bindings`, `push`, `constants`, `outputs` and `local_size` of a `Shader`, as Rust source. `words` must have been
/// compiled with debug names.
///
/// # Errors
/// When `words` is not valid SPIR-V, or a descriptor has no binding.
pub fn declarations(name: &str, words: &[u32]) -> Result<String, String> {
    let module = rspirv::dr::load_words(words).map_err(|e| format!("{name}: {e}"))?;
    let reflection = &Reflection::new(&module);
    let mut bindings = String::new();
    let mut push = String::from("None");
    for variable in &reflection.variables {
        let id = variable.result_id.unwrap_or_default();
        let block = reflection.pointee(variable).unwrap_or_default();
        if Reflection::storage(variable) == Some(StorageClass::PushConstant) {
            push = format!("Some(&[{}])", reflection.fields_text(block));
        }
        let Some(kind) = reflection.binding_kind(variable) else {
            continue;
        };
        let Some(binding) = reflection.decorations.get(&(id, Decoration::Binding)) else {
            return Err(format!(
                "{name}: {:?} has no binding",
                reflection.name(variable)
            ));
        };
        let _ = write!(
            bindings,
            "Binding {{ name: {:?}, binding: {binding}, kind: BindingKind::{kind}, fields: &[{}] }}, ",
            reflection.name(variable),
            if kind == "UniformBuffer" {
                reflection.fields_text(block)
            } else {
                String::new()
            },
        );
    }
    let mut constants: Vec<(&str, u32)> = reflection
        .decorations
        .iter()
        .filter(|((_, d), _)| *d == Decoration::SpecId)
        .map(|((id, _), value)| (reflection.names.get(id).copied().unwrap_or(""), *value))
        .collect();
    constants.sort_unstable();
    let local_size = module.execution_modes.iter().find_map(local_size);
    let outputs = reflection.outputs();
    Ok(format!(
        "bindings: &[{bindings}], push: {push}, constants: &{constants:?}, outputs: {outputs}, local_size: {local_size:?}"
    ))
}

/// Work group size, from the instruction that declares it.
fn local_size(mode: &Instruction) -> Option<[u32; 3]> {
    match mode.operands.as_slice() {
        [
            _,
            Operand::ExecutionMode(ExecutionMode::LocalSize),
            Operand::LiteralBit32(x),
            Operand::LiteralBit32(y),
            Operand::LiteralBit32(z),
        ] => Some([*x, *y, *z]),
        _ => None,
    }
}

/// The instructions of one stage, indexed by result ID.
struct Reflection<'m> {
    types: HashMap<Word, &'m Instruction>,
    names: HashMap<Word, &'m str>,
    members: HashMap<(Word, u32), &'m str>,
    decorations: HashMap<(Word, Decoration), u32>,
    offsets: HashMap<(Word, u32), u32>,
    variables: Vec<&'m Instruction>,
}

impl<'m> Reflection<'m> {
    fn new(module: &'m Module) -> Self {
        let mut this = Self {
            types: HashMap::new(),
            names: HashMap::new(),
            members: HashMap::new(),
            decorations: HashMap::new(),
            offsets: HashMap::new(),
            variables: Vec::new(),
        };
        for instruction in &module.debug_names {
            match instruction.operands.as_slice() {
                [Operand::IdRef(id), Operand::LiteralString(name)] => {
                    this.names.insert(*id, name);
                }
                [
                    Operand::IdRef(id),
                    Operand::LiteralBit32(i),
                    Operand::LiteralString(name),
                ] => {
                    this.members.insert((*id, *i), name);
                }
                _ => {}
            }
        }
        for instruction in &module.annotations {
            match instruction.operands.as_slice() {
                [
                    Operand::IdRef(id),
                    Operand::Decoration(d),
                    Operand::LiteralBit32(value),
                ] => {
                    this.decorations.insert((*id, *d), *value);
                }
                [
                    Operand::IdRef(id),
                    Operand::LiteralBit32(member),
                    Operand::Decoration(Decoration::Offset),
                    Operand::LiteralBit32(offset),
                ] => {
                    this.offsets.insert((*id, *member), *offset);
                }
                _ => {}
            }
        }
        for instruction in &module.types_global_values {
            if let Some(id) = instruction.result_id {
                this.types.insert(id, instruction);
            }
            if instruction.class.opcode == Op::Variable {
                this.variables.push(instruction);
            }
        }
        this
    }

    fn pointee(&self, variable: &Instruction) -> Option<Word> {
        match self.types.get(&variable.result_type?)?.operands.as_slice() {
            [Operand::StorageClass(_), Operand::IdRef(id)] => Some(*id),
            _ => None,
        }
    }

    fn storage(variable: &Instruction) -> Option<StorageClass> {
        match variable.operands.first()? {
            Operand::StorageClass(class) => Some(*class),
            _ => None,
        }
    }

    /// Number of outputs with a location.
    fn outputs(&self) -> usize {
        let is_located = |v: &&&Instruction| {
            let key = (v.result_id.unwrap_or_default(), Decoration::Location);
            self.decorations.contains_key(&key)
        };
        let written = |v: &&&Instruction| Self::storage(v) == Some(StorageClass::Output);
        self.variables
            .iter()
            .filter(written)
            .filter(is_located)
            .count()
    }

    /// Size of a type in `layout(scalar)`, bytes: no padding between components.
    fn size(&self, id: Word) -> Option<u32> {
        let instruction = self.types.get(&id)?;
        let literal = |i: usize| match instruction.operands.get(i) {
            Some(Operand::LiteralBit32(n)) => Some(*n),
            _ => None,
        };
        let inner = || match instruction.operands.first() {
            Some(Operand::IdRef(id)) => self.size(*id),
            _ => None,
        };
        match instruction.class.opcode {
            Op::TypeFloat | Op::TypeInt => Some(literal(0)? / 8),
            Op::TypeVector | Op::TypeMatrix => Some(inner()? * literal(1)?),
            Op::TypeArray => match instruction.operands.get(1) {
                Some(Operand::IdRef(length)) => {
                    let Operand::LiteralBit32(n) = self.types.get(length)?.operands.first()? else {
                        return None;
                    };
                    Some(inner()? * n)
                }
                _ => None,
            },
            Op::TypeStruct => {
                let fields = self.fields(id);
                fields.iter().map(|f| f.1 + f.2).max()
            }
            _ => None,
        }
    }

    /// Name, offset and size of the members of a block.
    fn fields(&self, id: Word) -> Vec<(&'m str, u32, u32)> {
        let Some(instruction) = self.types.get(&id) else {
            return Vec::new();
        };
        instruction
            .operands
            .iter()
            .enumerate()
            .filter_map(|(i, operand)| {
                let Operand::IdRef(member) = operand else {
                    return None;
                };
                let key = (id, i as u32);
                // A run-time array has no static size.
                let size = self.size(*member).unwrap_or(0);
                Some((*self.members.get(&key)?, *self.offsets.get(&key)?, size))
            })
            .collect()
    }

    fn name(&self, variable: &Instruction) -> &'m str {
        let own = variable
            .result_id
            .and_then(|id| self.names.get(&id))
            .copied()
            .unwrap_or("");
        if !own.is_empty() {
            return own;
        }
        self.pointee(variable)
            .and_then(|id| self.names.get(&id))
            .copied()
            .unwrap_or("")
    }

    fn binding_kind(&self, variable: &Instruction) -> Option<&'static str> {
        let pointee = self.types.get(&self.pointee(variable)?)?.class.opcode;
        match (Self::storage(variable)?, pointee) {
            (StorageClass::UniformConstant, Op::TypeSampledImage) => Some("SampledImage"),
            (StorageClass::UniformConstant, Op::TypeImage) => Some("StorageImage"),
            (StorageClass::Uniform, _) => Some("UniformBuffer"),
            (StorageClass::StorageBuffer, _) => Some("StorageBuffer"),
            _ => None,
        }
    }

    fn fields_text(&self, block: Word) -> String {
        self.fields(block)
            .iter()
            .map(|(name, offset, size)| {
                format!("Field {{ name: {name:?}, offset: {offset}, size: {size} }}, ")
            })
            .collect()
    }
}
