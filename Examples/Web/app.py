#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""An application in the browser: drop a mesh, choose a filter, move its sliders, see the surface
before and after, and download the result.

    Examples/Web/start.sh            # installs what is needed below build/web, and starts
    app.py [--port 8080] [--host 127.0.0.1] [--sessions 8]

Everybody who opens the page gets a process of their own (session.py) behind an address that cannot
be guessed, so that nobody sees the data of others. The data stay in the memory of this process and
are gone when the page has been closed for a minute. All of it runs over one port, which a tunnel of ssh
can forward. It listens to this machine only, unless --host says otherwise; there is no password.
"""
import argparse
import asyncio
import contextlib
import os
import secrets
import sys
import webbrowser
from pathlib import Path

from aiohttp import ClientSession, WSMsgType, web

LIFE = 60  # seconds that a page without a browser is kept
START = 60  # seconds that a page may take to start


class Session:
    """One person's process, and the way to it."""

    def __init__(self, process, port, key):
        self.process, self.port, self.key = process, port, key

    @property
    def alive(self):
        return self.process.returncode is None


async def start_session(life):
    """Starts a process, which listens to this machine and asks for a secret."""
    key = secrets.token_urlsafe(24)
    # Arguments can be read by everybody on the machine, the environment cannot.
    arguments = f"--server --host 127.0.0.1 --port 0 --timeout {life} --authKey={key}"
    process = await asyncio.create_subprocess_exec(
        sys.executable, str(Path(__file__).with_name("session.py")),
        stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE,
        env={**os.environ, "TRAME_ARGS": arguments, "WSLINK_READY_MSG": ""})
    while True:
        line = (await asyncio.wait_for(process.stdout.readline(), START)).decode()
        if not line:
            raise RuntimeError("the page's process has ended before it was ready")
        if line.startswith("port "):
            asyncio.ensure_future(drain(process.stdout))
            return Session(process, int(line.split()[1]), key)


async def drain(stream):
    while await stream.read(4096):
        pass


class Front:
    """Hands out sessions, and passes requests on to them."""

    def __init__(self, limit, life):
        self.sessions, self.limit, self.life, self.client = {}, limit, life, None
        self.lock = asyncio.Lock()

    def routes(self):
        return [web.get("/", self.open_page), web.route("*", "/{token}/{path:.*}", self.forward)]

    async def run(self, _):
        async with ClientSession(auto_decompress=False) as self.client:
            yield
            for session in self.sessions.values():
                if session.alive:
                    session.process.terminate()
                    await session.process.wait()

    async def open_page(self, _):
        async with self.lock:
            self.sessions = {token: s for token, s in self.sessions.items() if s.alive}
            if len(self.sessions) >= self.limit:
                return web.Response(status=503, text=f"{self.limit} people use this page at present; "
                                    "please try again in a minute.\n")
            session = await start_session(self.life)
            token = secrets.token_urlsafe(24)
            self.sessions[token] = session
        raise web.HTTPFound(f"/{token}/index.html?secret={session.key}")

    async def forward(self, request):
        session = self.sessions.get(request.match_info["token"])
        if session is None or not session.alive:
            return web.Response(status=404, content_type="text/html",
                                text='This page has ended. <a href="/">Open a new one.</a>\n')
        address = f"http://127.0.0.1:{session.port}/{request.match_info['path']}"
        if request.headers.get("Upgrade", "").lower() == "websocket":
            return await self.join(request, address)
        async with self.client.get(address, params=request.query) as answer:
            kept = {name: answer.headers[name] for name in ("Content-Type", "Content-Encoding")
                    if name in answer.headers}
            return web.Response(status=answer.status, body=await answer.read(), headers=kept)

    async def join(self, request, address):
        """A web socket to the browser and one to the session; each message goes to the other."""
        browser = web.WebSocketResponse(max_msg_size=0)
        await browser.prepare(request)
        async with self.client.ws_connect(address, max_msg_size=0) as inner:
            await asyncio.wait([asyncio.ensure_future(pump(browser, inner)),
                                asyncio.ensure_future(pump(inner, browser))],
                               return_when=asyncio.FIRST_COMPLETED)
        await browser.close()
        return browser


async def pump(source, target):
    with contextlib.suppress(ConnectionError):  # the target has closed meanwhile
        async for message in source:
            if message.type == WSMsgType.TEXT:
                await target.send_str(message.data)
            elif message.type == WSMsgType.BINARY:
                await target.send_bytes(message.data)


async def serve(args):
    front = Front(args.sessions, args.life)
    app = web.Application()
    app.add_routes(front.routes())
    app.cleanup_ctx.append(front.run)
    runner = web.AppRunner(app, access_log=None)
    await runner.setup()
    try:
        await web.TCPSite(runner, args.host, args.port).start()
        host, port = runner.addresses[0][:2]
        address = f"http://{host}:{port}/"
        print(f"The page is at {address} (Ctrl-C ends it)", flush=True)
        if args.browser:
            webbrowser.open(address)
        await asyncio.Event().wait()
    finally:
        await runner.cleanup()


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("--host", default="127.0.0.1", metavar="ADDRESS",
                        help="0.0.0.0 serves other machines, too (default: %(default)s)")
    parser.add_argument("--port", type=int, default=8080, metavar="N",
                        help="0: any that is free (default: %(default)s)")
    parser.add_argument("--sessions", type=int, default=8, metavar="N",
                        help="the number of people at a time (default: %(default)s)")
    parser.add_argument("--life", type=int, default=LIFE, metavar="SECONDS",
                        help="how long a page without a browser is kept (default: %(default)s)")
    parser.add_argument("--no-browser", dest="browser", action="store_false",
                        help="print the address only")
    try:
        asyncio.run(serve(parser.parse_args()))
    except KeyboardInterrupt:
        pass
    except OSError as problem:
        sys.exit(f"app.py: {problem}")


if __name__ == "__main__":
    main()
