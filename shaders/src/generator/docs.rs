//! The words that GLSL comments give to names, and the constants that GLSL declares.
//!
//! A line scanner, not a parser: it knows the forms that `shaders/README.md` asks for.

use std::collections::BTreeMap;

/// Comments by what they describe: `Bounds`, `Bounds.flags`, `bounds`, `PACK_CHUNK`.
#[derive(Clone, Debug, Default)]
pub struct Docs {
    items: BTreeMap<String, Vec<String>>,
}

impl Docs {
    /// Reads the comments of a text: those right above a declaration, and those at the end of its line.
    pub fn read(text: &str) -> Self {
        let mut reader = Reader::default();
        for line in text.lines() {
            reader.line(line.trim());
        }
        reader.docs
    }

    /// Adds what `other` knows and this does not.
    pub fn add(&mut self, other: &Docs) {
        for (name, lines) in &other.items {
            self.items.entry(name.clone()).or_insert_with(|| lines.clone());
        }
    }

    /// The comment of `key`, or a line that says where `name` comes from.
    pub fn of(&self, key: &str, name: &str) -> Vec<String> {
        match self.items.get(key) {
            Some(lines) => sentence(lines),
            None => vec![format!("`{name}` in GLSL.")],
        }
    }
}

/// Capital first, full stop last, brackets escaped so that rustdoc takes them as text.
pub fn sentence(lines: &[String]) -> Vec<String> {
    let mut lines: Vec<String> = lines.iter().map(|line| escape(line)).collect();
    if let Some(first) = lines.first_mut() {
        let mut letters = first.chars();
        if let Some(letter) = letters.next() {
            *first = letter.to_uppercase().chain(letters).collect();
        }
    }
    if let Some(last) = lines.last_mut().filter(|last| last.ends_with(|end: char| end.is_alphanumeric() || end == ')'))
    {
        last.push('.');
    }
    lines
}

fn escape(line: &str) -> String {
    let mut escaped = String::new();
    let mut code = false;
    for letter in line.chars() {
        code ^= letter == '`';
        if !code && "[]<>*".contains(letter) {
            escaped.push('\\');
        }
        escaped.push(letter);
    }
    escaped
}

/// The comment at the head of a shader, without its `family/verb_noun:`.
pub fn head(text: &str, stage: &str) -> Result<Vec<String>, String> {
    let comments = text.lines().map_while(|line| line.strip_prefix("//"));
    let mut lines: Vec<String> = comments.map(|line| line.trim().to_owned()).collect();
    let missing = || format!("begin with a comment `// {stage}: what it does`");
    let first = lines.first_mut().ok_or_else(missing)?;
    let what = first.strip_prefix(stage).and_then(|rest| rest.strip_prefix(':'));
    *first = what.ok_or_else(missing)?.trim().to_owned();
    Ok(sentence(&lines))
}

#[derive(Default)]
struct Reader {
    docs: Docs,
    above: Vec<String>,
    /// The struct or block whose members are being read, with the comment above it.
    inside: Option<(String, Vec<String>)>,
}

impl Reader {
    fn line(&mut self, line: &str) {
        if let Some(comment) = line.strip_prefix("//") {
            self.above.push(comment.trim().to_owned());
            return;
        }
        let (code, trailing) = line.split_once("//").unwrap_or((line, ""));
        let mut comment = std::mem::take(&mut self.above);
        if !trailing.trim().is_empty() {
            comment.push(trailing.trim().to_owned());
        }
        self.code(code.trim(), comment);
    }

    fn code(&mut self, code: &str, comment: Vec<String>) {
        if let Some((block, above)) = self.inside.clone() {
            if let Some(instance) = code.strip_prefix('}') {
                self.keep(instance.trim_end_matches(';').trim(), above);
                self.inside = None;
            } else {
                for name in declared(code) {
                    self.keep(&format!("{block}.{name}"), comment.clone());
                }
            }
        } else if let Some(block) = opened_block(code) {
            self.keep(block, comment.clone());
            match code.split_once('}') {
                Some((_, instance)) => self.keep(instance.trim_end_matches(';').trim(), comment),
                None => self.inside = Some((block.to_owned(), comment)),
            }
        } else if code.starts_with("layout") || code.starts_with("const ") {
            for name in declared(code) {
                self.keep(name, comment.clone());
            }
        }
    }

    fn keep(&mut self, key: &str, comment: Vec<String>) {
        if !key.is_empty() && !comment.is_empty() {
            self.docs.items.entry(key.to_owned()).or_insert(comment);
        }
    }
}

/// `NAME` in `struct NAME {`, `buffer NAME {` or `uniform NAME {`.
fn opened_block(code: &str) -> Option<&str> {
    let (before, _) = code.split_once('{')?;
    let mut words = before.split_whitespace().rev();
    let name = words.next()?;
    matches!(words.next()?, "struct" | "buffer" | "uniform").then_some(name)
}

/// The names in `TYPE a, b[4];` or `TYPE a = value;`.
fn declared(code: &str) -> Vec<&str> {
    let code = match code.starts_with("layout") {
        true => code.split_once(')').map_or("", |(_, rest)| rest),
        false => code,
    };
    match code.split_once(';') {
        Some((code, _)) => code.split('=').next().unwrap_or_default().split(',').filter_map(name_in).collect(),
        None => Vec::new(),
    }
}

fn name_in(part: &str) -> Option<&str> {
    part.split('[').next()?.split_whitespace().last()
}

/// A constant that GLSL and Rust share.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedConstant {
    /// Its name.
    pub name: String,
    /// Type and value as Rust text, such as `u32 = 5`.
    pub rust: String,
}

/// The constants of an included text: `const uint NAME = 5u;`, with a literal or two joined by an operator.
/// The second list names constants whose value is not that simple.
pub fn constants(text: &str) -> (Vec<SharedConstant>, Vec<String>) {
    let (mut known, mut skipped) = (Vec::new(), Vec::new());
    let mut values: BTreeMap<String, f64> = BTreeMap::new();
    for line in text.lines() {
        let Some((ty, name, expression)) = constant_line(line) else {
            continue;
        };
        match evaluate(expression, ty, &values).and_then(|value| Some((value, rust_value(ty, value, expression)?))) {
            Some((value, rust)) => {
                values.insert(name.to_owned(), value);
                known.push(SharedConstant { name: name.to_owned(), rust });
            }
            None => skipped.push(name.to_owned()),
        }
    }
    (known, skipped)
}

fn constant_line(line: &str) -> Option<(&str, &str, &str)> {
    let (declaration, rest) = line.strip_prefix("const ")?.split_once('=')?;
    let (ty, name) = declaration.trim().split_once(' ')?;
    let (expression, _) = rest.split_once(';')?;
    matches!(ty, "uint" | "int" | "float").then_some((ty, name.trim(), expression.trim()))
}

/// One literal or known name, or two joined by an operator with spaces around. Integers to 2^53 are exact in f64.
fn evaluate(expression: &str, ty: &str, known: &BTreeMap<String, f64>) -> Option<f64> {
    let term = |text: &str| known.get(text).copied().or_else(|| literal(text));
    for (operator, sign) in [(" + ", '+'), (" - ", '-'), (" * ", '*'), (" / ", '/'), (" << ", '<')] {
        if let Some((left, right)) = expression.split_once(operator) {
            let (left, right) = (term(left.trim())?, term(right.trim())?);
            return Some(match sign {
                '+' => left + right,
                '-' => left - right,
                '*' => left * right,
                '<' => left * right.exp2(),
                _ if ty == "float" => left / right,
                _ => (left / right).trunc(),
            });
        }
    }
    term(expression)
}

fn literal(text: &str) -> Option<f64> {
    let text = text.trim_end_matches(['u', 'U']);
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u32::from_str_radix(digits, 16).ok().map(f64::from),
        None => text.trim_end_matches(['f', 'F']).parse().ok(),
    }
}

fn rust_value(ty: &str, value: f64, expression: &str) -> Option<String> {
    let fits = |low: f64, high: f64| value.fract() == 0.0 && (low..=high).contains(&value);
    match ty {
        "float" => Some(format!("f32 = {:?}", value as f32)),
        "uint" if !fits(0.0, f64::from(u32::MAX)) => None,
        "uint" if expression.starts_with("0x") => Some(format!("u32 = {:#x}", value as u32)),
        "uint" => Some(format!("u32 = {}", value as u32)),
        _ if fits(f64::from(i32::MIN), f64::from(i32::MAX)) => Some(format!("i32 = {}", value as i32)),
        _ => None,
    }
}
