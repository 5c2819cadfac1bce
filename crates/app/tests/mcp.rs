//! `pliant mcp` as a client sees it: a session through the program's standard input and output, and refusals.
//!
//! Pictures are skipped by name if there is no graphics device.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "tests fail by panicking and say what they skip"
)]

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};

/// The version in which each request names it.
const OF_REQUESTS: &str = "2026-07-28";

/// The program, and its streams.
struct Client {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    next: u64,
}

impl Client {
    fn start(folder: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_pliant"))
            .arg("mcp")
            .current_dir(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .unwrap();
        let output = BufReader::new(child.stdout.take().unwrap());
        Self {
            input: child.stdin.take(),
            child,
            output,
            next: 0,
        }
    }

    /// Sends bytes and ends the line.
    fn send(&mut self, line: &[u8]) {
        let input = self.input.as_mut().unwrap();
        input.write_all(line).unwrap();
        input.write_all(b"\n").unwrap();
        input.flush().unwrap();
    }

    /// The next line of the output: each is one JSON-RPC message.
    fn receive(&mut self) -> Value {
        let mut line = String::new();
        self.output.read_line(&mut line).unwrap();
        let answer: Value = serde_json::from_str(&line).unwrap_or_else(|error| panic!("{error}: {line:?}"));
        assert_eq!(answer["jsonrpc"], "2.0", "{line}");
        answer
    }

    /// Sends a request and gives its answer.
    fn request(&mut self, method: &str, params: Value) -> Value {
        self.next += 1;
        let id = self.next;
        self.send(
            json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params })
                .to_string()
                .as_bytes(),
        );
        let answer = self.receive();
        assert_eq!(answer["id"], id, "{answer}");
        answer
    }

    fn notify(&mut self, method: &str, params: Value) {
        let line = json!({ "jsonrpc": "2.0", "method": method, "params": params });
        self.send(line.to_string().as_bytes());
    }

    fn greet(&mut self, version: &str) -> Value {
        let greeting = json!({
            "protocolVersion": version, "capabilities": {}, "clientInfo": { "name": "test", "version": "1" },
        });
        let answer = self.request("initialize", greeting)["result"].clone();
        self.notify("notifications/initialized", json!({}));
        answer
    }

    /// Calls a tool: its content, or its refusal.
    fn call(&mut self, tool: &str, arguments: Value) -> Result<Vec<Value>, String> {
        let answer = self.request("tools/call", json!({ "name": tool, "arguments": arguments }));
        let result = &answer["result"];
        let content = result["content"]
            .as_array()
            .unwrap_or_else(|| panic!("{answer}"))
            .clone();
        match result["isError"].as_bool().unwrap() {
            false => Ok(content),
            true => {
                let sentence = content[0]["text"].as_str().unwrap().to_owned();
                assert!(content.len() == 1 && sentence.lines().count() == 1, "{sentence}");
                Err(sentence)
            }
        }
    }

    /// Calls a tool that answers with JSON.
    fn call_for_json(&mut self, tool: &str, arguments: Value) -> Value {
        let content = self.call(tool, arguments).unwrap();
        serde_json::from_str(content[0]["text"].as_str().unwrap()).unwrap()
    }

    /// Asserts that a call is refused in a sentence with these words.
    fn refused(&mut self, tool: &str, arguments: Value, words: &[&str]) {
        let said = self.call(tool, arguments).unwrap_err();
        assert!(words.iter().all(|word| said.contains(word)), "{words:?}: {said}");
    }

    /// Closes the input: the program ends by itself.
    fn close(mut self) {
        drop(self.input.take());
        assert!(self.child.wait().unwrap().success());
    }
}

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets").join(name)
}

/// A folder with the sample `bar.glb` and its edit.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["bar.glb", "bar.edit.json"] {
        fs::copy(sample(name), folder.path().join(name)).unwrap();
    }
    folder
}

fn edit() -> Value {
    serde_json::from_slice(&fs::read(sample("bar.edit.json")).unwrap()).unwrap()
}

/// The file that `pliant apply` makes of the sample.
fn by_the_command_line(folder: &Path) -> Vec<u8> {
    let status = Command::new(env!("CARGO_BIN_EXE_pliant"))
        .args(["apply", "bar.glb", "--edit", "bar.edit.json", "--output", "applied.glb"])
        .current_dir(folder)
        .status()
        .unwrap();
    assert!(status.success());
    fs::read(folder.join("applied.glb")).unwrap()
}

#[test]
fn a_session_opens_selects_bends_and_saves_like_the_command_line() {
    let folder = folder();
    let expected = by_the_command_line(folder.path());
    let mut client = Client::start(folder.path());
    assert_eq!(client.greet("2025-06-18")["protocolVersion"], "2025-06-18");

    let info = client.call_for_json("info", json!({ "file": "bar.glb" }));
    let opened = client.call_for_json("open", json!({ "file": "bar.glb" }));
    assert_eq!(opened["vertices"], info["vertices"]);
    assert_eq!(opened["bounding_box"], info["bounding_box"]);
    let model = opened["model"].clone();

    let all = client.call_for_json("select", json!({ "model": model, "selector": "all" }));
    assert_eq!(
        (&all["selected"], &all["of"]),
        (&opened["welded_vertices"], &opened["welded_vertices"])
    );
    let end = json!({ "slab": { "axis": "longest", "from": 0.9, "to": 1.0 } });
    let end = client.call_for_json("select", json!({ "model": model, "selector": end }));
    let count = end["selected"].as_u64().unwrap();
    assert!(count > 0 && count < all["selected"].as_u64().unwrap(), "{end}");

    let report = client.call_for_json("apply", json!({ "model": model, "edit": edit() }));
    assert_eq!(report["method"], edit()["method"]["name"]);
    let said = client
        .call("save", json!({ "model": model, "output": "bent.glb" }))
        .unwrap();
    assert!(said[0]["text"].as_str().unwrap().contains("bent.glb"), "{said:?}");
    assert_eq!(fs::read(folder.path().join("bent.glb")).unwrap(), expected);

    // By its path the edit is the same, and another method gives another shape.
    client.call_for_json("apply", json!({ "model": model, "edit": "bar.edit.json" }));
    client
        .call("save", json!({ "model": model, "output": "again.glb" }))
        .unwrap();
    assert_eq!(fs::read(folder.path().join("again.glb")).unwrap(), expected);
    let other = json!({ "model": model, "edit": "bar.edit.json", "method": "primo" });
    assert_eq!(client.call_for_json("apply", other)["method"], "primo");
    client.call("close", json!({ "model": model })).unwrap();
    client.refused(
        "save",
        json!({ "model": model, "output": "late.glb" }),
        &["model-1", "open"],
    );
    client.close();
}

#[test]
fn pictures_come_as_png_and_an_edit_changes_them() {
    let folder = folder();
    let mut client = Client::start(folder.path());
    client.greet("2025-11-25");
    let model = client.call_for_json("open", json!({ "file": "bar.glb" }))["model"].clone();
    client.refused(
        "render",
        json!({ "model": model, "look": { "view": "behind" } }),
        &["view", "behind", "front"],
    );
    client.refused(
        "render",
        json!({ "model": model, "look": { "size": "4000x10" } }),
        &["4000x10", "2048"],
    );
    client.refused(
        "compare",
        json!({ "model": model, "methods": ["arap"] }),
        &["model-1", "apply"],
    );
    if let Err(error) = pliant_render::Headless::new() {
        eprintln!("skipped: pictures ({error})");
        return client.close();
    }
    let look = json!({ "size": "120x90", "view": "front" });
    let picture = |client: &mut Client, original: bool| {
        let arguments = json!({ "model": model, "look": look, "original": original });
        let content = client.call("render", arguments).unwrap();
        assert_eq!(
            (&content[0]["type"], &content[0]["mimeType"]),
            (&json!("image"), &json!("image/png"))
        );
        let png = BASE64_STANDARD.decode(content[0]["data"].as_str().unwrap()).unwrap();
        let decoded = image::load_from_memory(&png).unwrap();
        assert_eq!((decoded.width(), decoded.height()), (120, 90));
        decoded.into_rgba8()
    };
    let before = picture(&mut client, false);
    client.call_for_json("apply", json!({ "model": model, "edit": edit() }));
    assert_ne!(picture(&mut client, false), before);
    assert_eq!(picture(&mut client, true), before);

    let compared = json!({ "model": model, "methods": ["arap", "bilaplacian"], "look": { "size": "400x300" } });
    let content = client.call("compare", compared).unwrap();
    let table = content[0]["text"].as_str().unwrap();
    assert!(table.contains("arap") && table.contains("bilaplacian"), "{table}");
    assert_eq!(content[1]["type"], "image");
    client.close();
}

#[test]
fn a_file_is_replaced_only_on_request_and_its_original_is_kept() {
    let folder = folder();
    let expected = by_the_command_line(folder.path());
    let source = fs::read(sample("bar.glb")).unwrap();
    let mut client = Client::start(folder.path());
    client.greet("2025-11-25");
    let model = client.call_for_json("open", json!({ "file": "bar.glb" }))["model"].clone();
    client.call_for_json("apply", json!({ "model": model, "edit": "bar.edit.json" }));
    let at = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let to = |output: &str, replace: bool| json!({ "model": model, "output": output, "replace": replace });

    client.refused("save", to("bar.glb", false), &["bar.glb", "replace"]);
    client.refused(
        "save",
        to("applied.glb", false),
        &["applied.glb", "there already", "replace"],
    );
    client.refused("save", to("bar.edit.json", true), &["bar.edit.json"]);
    client.refused("save", to("no/such/folder.glb", false), &["folder"]);
    client.refused("save", to("bent.doc", false), &["bent.doc", ".glb"]);
    assert_eq!((at("bar.glb"), at("applied.glb")), (source.clone(), expected.clone()));
    let names = |folder: &Path| fs::read_dir(folder).unwrap().count();
    assert_eq!(names(folder.path()), 3, "a refusal leaves no file");

    let said = client.call("save", to("bar.glb", true)).unwrap();
    let said = said[0]["text"].as_str().unwrap();
    assert!(said.contains("bar.original.glb"), "{said}");
    assert_eq!((at("bar.glb"), at("bar.original.glb")), (expected.clone(), source));
    // The model is the saved file now: saved as it is, it has the same bytes.
    client.call("save", to("same.glb", false)).unwrap();
    assert_eq!(at("same.glb"), expected);
    client.close();
}

#[test]
fn wrong_requests_are_refused_and_the_session_goes_on() {
    let folder = folder();
    let mut client = Client::start(folder.path());
    let refusal = |client: &mut Client, line: &[u8], id: Value, code: i64| {
        client.send(line);
        let answer = client.receive();
        assert_eq!(
            (&answer["id"], &answer["error"]["code"]),
            (&id, &json!(code)),
            "{answer}"
        );
        assert!(answer["error"]["message"].as_str().is_some_and(|said| !said.is_empty()));
    };
    refusal(&mut client, b"{\"jsonrpc\": \"2.0\", \"id\": 1, ", Value::Null, -32700);
    refusal(&mut client, b"\xff\xfe", Value::Null, -32700);
    refusal(&mut client, "[".repeat(100_000).as_bytes(), Value::Null, -32700);
    refusal(&mut client, b"[1, 2]", Value::Null, -32600);
    refusal(&mut client, b"{\"id\": 5, \"method\": \"ping\"}", json!(5), -32600);
    let unknown = json!({ "jsonrpc": "2.0", "id": "a", "method": "resources/list" });
    refusal(&mut client, unknown.to_string().as_bytes(), json!("a"), -32601);
    let unknown = json!({ "jsonrpc": "2.0", "id": 6, "method": "tools/call", "params": { "name": "melt" } });
    refusal(&mut client, unknown.to_string().as_bytes(), json!(6), -32602);
    let nameless = json!({ "jsonrpc": "2.0", "id": 7, "method": "tools/call" });
    refusal(&mut client, nameless.to_string().as_bytes(), json!(7), -32602);
    // Neither notifications nor empty lines are answered: the next answer is the next request's.
    client.notify("notifications/unknown", json!(null));
    client.send(b"");

    client.greet("1999-01-01");
    client.refused("open", json!({ "file": "none.glb" }), &["none.glb"]);
    client.refused("open", json!({ "file": "bar.edit.json" }), &["bar.edit.json", ".glb"]);
    client.refused("open", json!({}), &["open", "file"]);
    client.refused("open", json!({ "file": "bar.glb", "units": "mm" }), &["units", "weld"]);
    client.refused("open", json!({ "file": "bar.glb", "weld": -1.0 }), &["weld", "-1"]);
    client.refused(
        "apply",
        json!({ "model": "model-1", "edit": edit() }),
        &["model-1", "open"],
    );
    client.refused("render", json!({ "model": "model-1" }), &["model-1", "open"]);
    let model = client.call_for_json("open", json!({ "file": "bar.glb" }))["model"].clone();
    client.refused(
        "apply",
        json!({ "model": model, "edit": { "version": 1 } }),
        &["edit", "method"],
    );
    client.refused("apply", json!({ "model": model, "edit": "none.json" }), &["none.json"]);
    client.refused(
        "apply",
        json!({ "model": model, "edit": edit(), "method": "magic" }),
        &["magic", "arap"],
    );
    client.refused(
        "select",
        json!({ "model": model, "selector": "some" }),
        &["selector", "some"],
    );
    let outside = json!({ "vertices": [999_999] });
    client.refused("select", json!({ "model": model, "selector": outside }), &["999999"]);
    client.refused("compare", json!({ "model": model, "methods": [] }), &["methods"]);
    client.refused(
        "compare",
        json!({ "model": model, "methods": ["arap", "arap"], "edit": edit() }),
        &["methods", "arap", "twice"],
    );
    assert!(client.request("ping", json!({}))["result"].is_object());
    client.close();
}

#[test]
fn each_request_may_name_the_newest_version_instead_of_a_greeting() {
    let folder = folder();
    let mut client = Client::start(folder.path());
    let meta = |version: &str| {
        json!({
            "io.modelcontextprotocol/protocolVersion": version,
            "io.modelcontextprotocol/clientCapabilities": {},
        })
    };
    let found = client.request("server/discover", json!({ "_meta": meta(OF_REQUESTS) }));
    let versions = found["result"]["supportedVersions"].as_array().unwrap();
    assert!(versions.contains(&json!(OF_REQUESTS)) && versions.contains(&json!("2025-11-25")));
    let listed = client.request("tools/list", json!({ "_meta": meta(OF_REQUESTS) }));
    let result = &listed["result"];
    assert_eq!(
        (&result["resultType"], &result["cacheScope"]),
        (&json!("complete"), &json!("public"))
    );
    let tools: Vec<&str> = result["tools"]
        .as_array()
        .unwrap()
        .iter()
        .map(|tool| tool["name"].as_str().unwrap())
        .collect();
    let all = [
        "info",
        "open",
        "edit_format",
        "select",
        "apply",
        "render",
        "compare",
        "save",
        "close",
    ];
    assert_eq!(tools, all);
    for tool in result["tools"].as_array().unwrap() {
        let schema = &tool["inputSchema"];
        assert_eq!(schema["type"], "object");
        for name in schema["required"].as_array().unwrap() {
            assert!(schema["properties"][name.as_str().unwrap()].is_object(), "{tool}");
        }
    }
    let call = json!({ "name": "open", "arguments": { "file": "bar.glb" }, "_meta": meta(OF_REQUESTS) });
    assert_eq!(client.request("tools/call", call)["result"]["isError"], false);

    let other = client.request("tools/list", json!({ "_meta": meta("1900-01-01") }));
    assert_eq!(other["error"]["code"], -32022);
    assert_eq!(other["error"]["data"]["requested"], "1900-01-01");
    let bare = json!({ "io.modelcontextprotocol/protocolVersion": OF_REQUESTS });
    assert_eq!(
        client.request("tools/list", json!({ "_meta": bare }))["error"]["code"],
        -32602
    );
    // A client of the older era asks without a version, and falls back to `initialize`.
    assert_eq!(client.request("server/discover", json!({}))["error"]["code"], -32602);
    assert_eq!(client.greet("2024-11-05")["protocolVersion"], "2024-11-05");
    client.close();
}

/// A cancelled request has no answer, whether it waits or is worked on.
#[test]
fn a_cancelled_request_is_not_answered() {
    let folder = folder();
    let mut client = Client::start(folder.path());
    client.greet("2025-11-25");
    let opened = client.call_for_json("open", json!({ "file": "bar.glb" }));
    let model = &opened["model"];
    let bend = |id: &str| {
        let arguments = json!({ "model": model, "edit": edit(), "method": "primo" });
        json!({ "jsonrpc": "2.0", "id": id, "method": "tools/call",
            "params": { "name": "apply", "arguments": arguments } })
        .to_string()
    };
    let cancel = json!({ "jsonrpc": "2.0", "method": "notifications/cancelled", "params": { "requestId": "second" } });
    // One write, so that the cancellation is read long before the first request is done.
    let lines = [bend("first"), bend("second"), cancel.to_string()].join("\n");
    client.send(lines.as_bytes());
    let first = client.receive();
    assert_eq!(
        (&first["id"], &first["result"]["isError"]),
        (&json!("first"), &json!(false))
    );
    assert!(client.request("ping", json!({}))["result"].is_object());
    client.close();
}

/// Requests that were read before the input ended are answered, so that a script can pipe them in.
#[test]
fn requests_before_the_end_of_the_input_are_answered() {
    let folder = folder();
    let mut client = Client::start(folder.path());
    client.send(br#"{"jsonrpc": "2.0", "id": 1, "method": "ping"}"#);
    client
        .input
        .as_mut()
        .unwrap()
        .write_all(br#"{"jsonrpc": "2.0", "id": 2, "method": "ping"}"#)
        .unwrap();
    drop(client.input.take());
    assert_eq!(
        [client.receive(), client.receive()].map(|answer| answer["id"].clone()),
        [json!(1), json!(2)]
    );
    client.close();
}
