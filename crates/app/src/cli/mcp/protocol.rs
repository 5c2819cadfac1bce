//! The protocol's methods: greeting, versions, and calls of tools.

use pliant_engine::EngineError;
use pliant_engine::watch::Watch;
use pliant_io::quoted;
use pliant_mesh::Cancel;
use serde_json::{Value, json};

use super::answer::{Answer, refused};
use super::message::{Fault, INVALID_PARAMS, METHOD_NOT_FOUND};
use super::models::Models;
use super::tools::{INSTRUCTIONS, TOOLS, Tool};
use crate::cli::console::plain;
use crate::cli::shared_arguments::ComputeArguments;
use crate::cli::threads::on_threads;

/// The version whose requests each name it.
const OF_REQUESTS: &str = "2026-07-28";

/// The versions that begin with `initialize`, the newest first.
const OF_SESSIONS: [&str; 4] = ["2025-11-25", "2025-06-18", "2025-03-26", "2024-11-05"];

/// The protocol's code for a version that the server does not speak.
const UNSUPPORTED_VERSION: i64 = -32022;

/// The time for which a client may keep the list of tools, which never changes.
const FRESH_MS: u64 = 3_600_000;

/// The version that a request names.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Era {
    /// It names one.
    Requests,
    /// It names none: an `initialize` came before.
    Sessions,
}

/// Answers a request.
///
/// # Errors
/// The refusal of a request that the protocol does not have, or whose parameters are wrong. A refusal of a tool is a
/// result.
pub fn answer(method: &str, params: &Value, models: &mut Models, cancel: &Cancel) -> Result<Value, Fault> {
    let era = era(method, params)?;
    let mut result = match (method, era) {
        ("initialize", Era::Sessions) => initialized(params),
        ("ping", Era::Sessions) => json!({}),
        ("server/discover", _) => kept(json!({
            "supportedVersions": versions(),
            "capabilities": capabilities(),
            "serverInfo": server(),
            "instructions": INSTRUCTIONS,
        })),
        ("tools/list", _) => {
            let tools: Vec<Value> = TOOLS.iter().map(Tool::declaration).collect();
            let list = json!({ "tools": tools });
            match era {
                Era::Requests => kept(list),
                Era::Sessions => list,
            }
        }
        ("tools/call", _) => called(params, models, cancel)?,
        _ => {
            let said = format!(
                "there is no method {} here: this server has tools alone",
                quoted(method)
            );
            return Err(Fault::new(METHOD_NOT_FOUND, said));
        }
    };
    if era == Era::Requests {
        result["resultType"] = json!("complete");
        result["_meta"] = json!({ "io.modelcontextprotocol/serverInfo": server() });
    }
    Ok(result)
}

/// The era of a request.
fn era(method: &str, params: &Value) -> Result<Era, Fault> {
    let meta = &params["_meta"];
    let version = &meta["io.modelcontextprotocol/protocolVersion"];
    match version.as_str() {
        None if method == "server/discover" => {
            let said = "`_meta` has no `io.modelcontextprotocol/protocolVersion`, which each request needs";
            Err(Fault::new(INVALID_PARAMS, said))
        }
        None => Ok(Era::Sessions),
        Some(OF_REQUESTS) if meta["io.modelcontextprotocol/clientCapabilities"].is_object() => Ok(Era::Requests),
        Some(OF_REQUESTS) => {
            let said = "`_meta` has no `io.modelcontextprotocol/clientCapabilities`, which each request needs";
            Err(Fault::new(INVALID_PARAMS, said))
        }
        Some(other) => Err(Fault {
            code: UNSUPPORTED_VERSION,
            message: format!("the protocol's version {} is not supported", quoted(other)),
            data: json!({ "supported": versions(), "requested": other }),
        }),
    }
}

fn versions() -> Vec<&'static str> {
    [OF_REQUESTS].into_iter().chain(OF_SESSIONS).collect()
}

/// The answer to `initialize`: the client's version if this server speaks it, or else the newest.
fn initialized(params: &Value) -> Value {
    let asked = params["protocolVersion"].as_str();
    let version = OF_SESSIONS.into_iter().find(|version| asked == Some(version));
    json!({
        "protocolVersion": version.unwrap_or(OF_SESSIONS[0]),
        "capabilities": capabilities(),
        "serverInfo": server(),
        "instructions": INSTRUCTIONS,
    })
}

fn capabilities() -> Value {
    json!({ "tools": {} })
}

fn server() -> Value {
    json!({ "name": "pliant", "title": "Pliant", "version": env!("CARGO_PKG_VERSION") })
}

/// A result that the client may keep.
fn kept(mut result: Value) -> Value {
    result["ttlMs"] = json!(FRESH_MS);
    result["cacheScope"] = json!("public");
    result
}

/// Calls a tool. Its refusal is a result, which the assistant reads, in the command line's words.
fn called(params: &Value, models: &mut Models, cancel: &Cancel) -> Result<Value, Fault> {
    let name = params["name"].as_str();
    let name = name.ok_or_else(|| Fault::new(INVALID_PARAMS, "`name` is missing or no string"))?;
    let tool = Tool::named(name).ok_or_else(|| {
        let names: Vec<&str> = TOOLS.iter().map(|tool| tool.name).collect();
        let said = format!("there is no tool {}: use one of {}", quoted(name), names.join(", "));
        Fault::new(INVALID_PARAMS, said)
    })?;
    let arguments = match &params["arguments"] {
        Value::Null => json!({}),
        arguments => arguments.clone(),
    };
    let watch = Watch::cancelled_by(cancel);
    let done = on_threads(ComputeArguments::default(), || tool.call(models, arguments, &watch));
    Ok(match done.and_then(|done| done) {
        Ok(answer) => Answer::into_result(answer),
        Err(error) => refused(&sentence(&error)),
    })
}

/// A refusal as one line without control characters.
fn sentence(error: &EngineError) -> String {
    plain(&error.without_dashes().replace(['\n', '\r'], " "))
}
