#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""An application in the browser: drop a mesh, choose a filter, move its sliders, see the surface
before and after, and download the result.

    Examples/Web/start.sh            # installs what is needed below build/web, and starts
    app.py [--port 8080] [--host 127.0.0.1] [--name NAME] [--sessions 8]

Everybody who opens the page gets a process of their own (session.py) behind an address that cannot
be guessed, so that nobody sees the data of others. The data stay in the memory of this process and
are gone when the page has been closed for a minute. All of it runs over one port, which a tunnel of ssh
can forward. It listens to this machine only, unless --host says otherwise; there is no password.
Pages of other sites cannot open sessions, neither by links and pictures nor by a name that they let
point to this machine: requests must name an address, localhost, or a --name.
"""
import argparse
import asyncio
import contextlib
import ipaddress
import os
import secrets
import sys
import webbrowser
from pathlib import Path

from aiohttp import ClientConnectionError, ClientSession, WSMsgType, web

LIFE = 60  # seconds that a page without a browser is kept
START = 60  # seconds that a page may take to start
MESSAGE = 10_004_096  # bytes of a message from a browser, as in the session's own server


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

    def __init__(self, limit, life, names=()):
        self.sessions, self.limit, self.life, self.client = {}, limit, life, None
        self.names = {"localhost", *names}
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

    @web.middleware
    async def check_host(self, request, handler):
        """A name that belongs to another site may point to this machine (DNS rebinding), so that the
        site's pages may read the answers; an address may not."""
        if not self.allows(request.host):
            return web.Response(status=403, text=f"The address names {request.host}; allowed: a numeric "
                                f"address, {', '.join(sorted(self.names))} (app.py --name adds one).\n")
        return await handler(request)

    def allows(self, host):
        name = host.rsplit(":", 1)[0] if not host.endswith("]") else host
        try:
            ipaddress.ip_address(name.strip("[]"))
        except ValueError:
            return name.lower() in self.names
        return True

    async def open_page(self, request):
        if request.headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin"):
            return web.Response(status=403, text="Another site has asked for this page; allowed: its "
                                "address, typed or copied into the browser.\n")
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
        if session is not None and session.alive:
            with contextlib.suppress(ClientConnectionError):  # it may end meanwhile
                return await self.forward_to(session, request)
        return web.Response(status=404, content_type="text/html",
                            text='This page has ended. <a href="/">Open a new one.</a>\n')

    async def forward_to(self, session, request):
        address = f"http://127.0.0.1:{session.port}/{request.match_info['path']}"
        if request.headers.get("Upgrade", "").lower() == "websocket":
            return await self.join(request, address)
        if request.match_info["path"] == "ws":  # the session would wait for its messages for ever
            return web.Response(status=426, text="This address is for web sockets.\n",
                                headers={"Upgrade": "websocket"})
        async with self.client.get(address, params=request.query) as answer:
            kept = {name: answer.headers[name] for name in ("Content-Type", "Content-Encoding")
                    if name in answer.headers}
            return web.Response(status=answer.status, body=await answer.read(), headers=kept)

    async def join(self, request, address):
        """A web socket to the browser and one to the session; each message goes to the other."""
        browser = web.WebSocketResponse(max_msg_size=MESSAGE)
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
    front = Front(args.sessions, args.life, args.name)
    app = web.Application(middlewares=[front.check_host])
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
    parser.add_argument("--name", action="append", default=[], metavar="NAME",
                        help="a name of this machine by which browsers may ask for the page; may be "
                        "repeated (default: localhost)")
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
