//! Text and lists of numbers.

/// Appends a text.
pub(super) fn push(out: &mut Vec<u8>, text: &str) {
    out.extend_from_slice(text.as_bytes());
}

/// Appends numbers with commas between them.
pub(super) fn push_list<N: Copy>(out: &mut Vec<u8>, numbers: &[N], push_number: impl Fn(&mut Vec<u8>, N)) {
    for (place, &number) in numbers.iter().enumerate() {
        if place > 0 {
            push(out, ", ");
        }
        push_number(out, number);
    }
}
