//! JSON-RPC 2.0: a line as a message, and the answers.

use serde_json::{Value, json};

/// The message is no JSON.
pub const PARSE_ERROR: i64 = -32700;
/// The JSON is no request.
pub const INVALID_REQUEST: i64 = -32600;
/// The server does not have this method.
pub const METHOD_NOT_FOUND: i64 = -32601;
/// The parameters are wrong.
pub const INVALID_PARAMS: i64 = -32602;

/// A request's number or name, which its answer repeats.
pub type Id = Value;

/// A message of the client.
#[derive(Clone, PartialEq, Debug)]
pub enum Message {
    /// A request, which is answered.
    Request {
        /// A string or an integer.
        id: Id,
        /// The method's name.
        method: String,
        /// The parameters; null if there are none.
        params: Value,
    },
    /// A notification, which is not answered.
    Notification {
        /// Its name.
        method: String,
        /// The parameters; null if there are none.
        params: Value,
    },
    /// An answer to a request of the server, which makes none.
    Answer,
}

/// A refusal of a message.
#[derive(Clone, PartialEq, Debug)]
pub struct Fault {
    /// JSON-RPC's code.
    pub code: i64,
    /// The sentence.
    pub message: String,
    /// More for the client; null if there is none.
    pub data: Value,
}

impl Fault {
    /// A refusal without data.
    pub fn new(code: i64, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
            data: Value::Null,
        }
    }
}

/// Reads a line.
///
/// # Errors
/// The refusal, with the id of the request if it could be read, or else null.
pub fn message(line: &[u8]) -> Result<Message, (Id, Fault)> {
    let read = serde_json::from_slice(line).map_err(|error| {
        let said = format!("the line is no JSON: {error}; send one JSON-RPC message on each line");
        (Value::Null, Fault::new(PARSE_ERROR, said))
    })?;
    let Value::Object(mut members) = read else {
        let said = "a message is an object: send each request on a line of its own, not in an array";
        return Err((Value::Null, Fault::new(INVALID_REQUEST, said)));
    };
    let id = members.remove("id");
    let is_id = |id: &Value| id.is_string() || id.is_i64() || id.is_u64();
    let known = id.clone().filter(is_id).unwrap_or_default();
    let refuse = |said: &str| Err((known.clone(), Fault::new(INVALID_REQUEST, said)));
    if members.get("jsonrpc") != Some(&json!("2.0")) {
        return refuse("`jsonrpc` is not \"2.0\": this server speaks JSON-RPC 2.0");
    }
    let params = members.remove("params").unwrap_or_default();
    match (members.remove("method"), id) {
        (Some(Value::String(method)), None) => Ok(Message::Notification { method, params }),
        (Some(Value::String(method)), Some(id)) if is_id(&id) => Ok(Message::Request { id, method, params }),
        (Some(Value::String(_)), Some(_)) => refuse("`id` is neither a string nor an integer"),
        (None, _) if members.contains_key("result") || members.contains_key("error") => Ok(Message::Answer),
        _ => refuse("`method` is missing or no string"),
    }
}

/// The answer of a request that was done.
pub fn result(id: &Id, result: Value) -> Value {
    json!({ "jsonrpc": "2.0", "id": id, "result": result })
}

/// The answer of a message that was refused.
pub fn error(id: &Id, fault: &Fault) -> Value {
    let mut error = json!({ "code": fault.code, "message": fault.message });
    if !fault.data.is_null() {
        error["data"] = fault.data.clone();
    }
    json!({ "jsonrpc": "2.0", "id": id, "error": error })
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn requests_notifications_and_answers_are_told_apart() {
        let request = message(br#"{"jsonrpc":"2.0","id":1,"method":"ping"}"#).unwrap();
        let ping = "ping".to_owned();
        assert_eq!(
            request,
            Message::Request {
                id: json!(1),
                method: ping.clone(),
                params: Value::Null
            }
        );
        let told = message(br#"{"jsonrpc":"2.0","method":"ping","params":{}}"#).unwrap();
        assert_eq!(
            told,
            Message::Notification {
                method: ping,
                params: json!({})
            }
        );
        let answer = message(br#"{"jsonrpc":"2.0","id":"a","result":{}}"#).unwrap();
        assert_eq!(answer, Message::Answer);
    }

    #[test]
    fn a_refusal_names_the_request_if_it_has_a_name() {
        for (line, id, code) in [
            ("{", Value::Null, PARSE_ERROR),
            ("\u{fffd}", Value::Null, PARSE_ERROR),
            ("[]", Value::Null, INVALID_REQUEST),
            (r#"{"id":7,"method":"ping"}"#, json!(7), INVALID_REQUEST),
            (
                r#"{"jsonrpc":"2.0","id":null,"method":"ping"}"#,
                Value::Null,
                INVALID_REQUEST,
            ),
            (
                r#"{"jsonrpc":"2.0","id":1.5,"method":"ping"}"#,
                Value::Null,
                INVALID_REQUEST,
            ),
            (r#"{"jsonrpc":"2.0","id":"x","method":3}"#, json!("x"), INVALID_REQUEST),
        ] {
            let (told, fault) = message(line.as_bytes()).unwrap_err();
            assert_eq!((told, fault.code), (id, code), "{line}");
        }
        let deep = "[".repeat(10_000);
        assert_eq!(message(deep.as_bytes()).unwrap_err().1.code, PARSE_ERROR);
    }
}
