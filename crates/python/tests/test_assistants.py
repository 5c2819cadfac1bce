"""A session of `pliant mcp` with the protocol's own client for Python."""

import asyncio
import json

from conftest import ROOT, needed
from test_command_line import run

CREATURE = ROOT / "assets" / "creature.glb"
EDIT = ROOT / "assets" / "creature.edit.json"


def test_the_official_client_opens_selects_bends_and_saves(program, tmp_path):
    mcp = needed("mcp")
    stdio = needed("mcp.client.stdio")

    async def session():
        server = mcp.StdioServerParameters(command=str(program), args=["mcp"])
        async with stdio.stdio_client(server) as (reading, writing):
            async with mcp.ClientSession(reading, writing) as client:
                await client.initialize()
                tools = [tool.name for tool in (await client.list_tools()).tools]
                assert {"info", "open", "select", "apply", "render", "compare", "save", "close"} <= set(tools)

                async def call(name, **arguments):
                    answer = await client.call_tool(name, arguments)
                    return answer.content[0].text

                opened = json.loads(await call("open", file=str(CREATURE)))
                model = opened["model"]
                top = {"slab": {"axis": "y", "from": 0.9, "to": 1}}
                assert json.loads(await call("select", model=model, selector=top))["selected"] > 0
                assert "no model is open as nobody" in await call("apply", model="nobody", edit={})
                await call("apply", model=model, edit=json.loads(EDIT.read_text()))
                await call("save", model=model, output=str(tmp_path / "own.glb"))
                await call("close", model=model)

    asyncio.run(asyncio.wait_for(session(), 120))
    run(program, "apply", CREATURE, "--edit", EDIT, "--output", tmp_path / "expected.glb")
    assert (tmp_path / "own.glb").read_bytes() == (tmp_path / "expected.glb").read_bytes()
