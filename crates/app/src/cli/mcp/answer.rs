//! A tool's answer: texts and pictures.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};

/// The parts of an answer.
#[derive(Default)]
pub struct Answer(Vec<Value>);

impl Answer {
    /// An answer of one text.
    pub fn text(text: impl Into<String>) -> Self {
        Self::default().and_text(text)
    }

    /// An answer of one JSON value, as text.
    pub fn json(value: &Value) -> Self {
        Self::text(format!("{value:#}"))
    }

    /// The answer and a text.
    pub fn and_text(mut self, text: impl Into<String>) -> Self {
        let text: String = text.into();
        if !text.is_empty() {
            self.0.push(json!({ "type": "text", "text": text }));
        }
        self
    }

    /// The answer and a picture, as PNG bytes.
    pub fn and_png(mut self, png: &[u8]) -> Self {
        let data = BASE64_STANDARD.encode(png);
        self.0
            .push(json!({ "type": "image", "data": data, "mimeType": "image/png" }));
        self
    }

    /// The result of a call.
    pub fn into_result(self) -> Value {
        json!({ "content": self.0, "isError": false })
    }
}

/// The result of a call that was refused: the assistant reads the sentence and can do better.
pub fn refused(sentence: &str) -> Value {
    json!({ "content": [{ "type": "text", "text": sentence }], "isError": true })
}
