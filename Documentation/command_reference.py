# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The page of the command, from its parser: page() as Markdown."""
import argparse
import re

from surfacediffusion.command.arguments import make_parser

HEAD = """# The command

`pip install ".[io,cli]"` installs the command `surfacediffusion`, which applies the filters to files. Each
sub-command has its own `--help`; this page is made from the same texts. The names of Workbench's options
with one dash are taken, too: see [coming from Workbench](coming_from.md).

Exit codes: 0 success, 1 the computation failed or was interrupted, 2 arguments or files are wrong.
Errors are one line on standard error. An output appears complete or not at all.

Commands, options and files are completed in bash and zsh after `eval "$(surfacediffusion --completion bash)"`
(`zsh`), and in fish after `surfacediffusion --completion fish | source`. `surfacediffusion doctor` shows what is installed, and whether results are right on this machine.

"""


def page():
    commands = [action for action in make_parser()._actions
                if isinstance(action, argparse._SubParsersAction)][0].choices
    cifti = [action for action in make_parser(True)._actions
             if isinstance(action, argparse._SubParsersAction)][0].choices
    table = "\n".join(f"| [{name}](#{name}) | {_first_sentence(parser)} |"
                      for name, parser in commands.items())
    parts = [_part(name, parser, cifti[name]) for name, parser in commands.items()]
    return f"{HEAD}| command | what it does |\n| --- | --- |\n{table}\n\n" + "\n".join(parts)


def _first_sentence(parser):
    return _escape(re.split(r"(?<=[.:]) ", " ".join(parser.description.split()))[0].rstrip(".:"))


def _part(name, parser, cifti):
    positional = [a for a in parser._actions if not a.option_strings]
    usage = " ".join(["surfacediffusion", name, *(_word(a) for a in positional), "[options]"])
    example, _, rest = parser.epilog.removeprefix("Example:\n").partition("\n\n")
    example, *more = re.split(r"\n(?=\S)", example, maxsplit=1)
    rows = [(_word(a) if not a.option_strings else ", ".join(_option(a)), a.help or "")
            for a in sorted(parser._actions, key=lambda a: bool(a.option_strings))  # OUTPUT before --json
            if a.help != argparse.SUPPRESS and a.dest != "help"]
    known = {text for text, _ in rows}
    rows += [(text, a.help) for a in cifti._actions if a.option_strings and a.dest in (
        "left", "right", "cerebellum") for text in [", ".join(_option(a))] if text not in known]
    table = "\n".join(f"| `{_in_code(text)}` | {_escape(words % {} if '%%' in words else words)} |"
                      for text, words in rows)
    files = " ".join([*more, rest]).strip()
    lines = "\n".join(line.strip() for line in example.splitlines())
    return (f"## {name}\n\n{_escape(' '.join(parser.description.split()))}\n\n```text\n{usage}\n```\n\n"
            f"| argument | meaning |\n| --- | --- |\n{table}\n\nExample:\n\n```sh\n{lines}\n```\n\n"
            f"{_escape(' '.join(files.split()))}\n")


def _word(action):
    name = action.metavar or action.dest.upper()
    name = name if isinstance(name, str) else " ".join(name)  # of several values
    return f"{name}..." if action.nargs == "+" else name


def _option(action):
    value = "" if action.nargs == 0 else " " + _value(action)
    return [text + value for text in action.option_strings]


def _value(action):
    if action.choices:
        return "{" + ",".join(map(str, action.choices)) + "}"
    return _word(action)


def _in_code(text):
    return text.replace("|", "\\|")  # bars end the cells of a table


def _escape(text):
    text = re.sub(r"([|<>*_])", r"\\\1", text)
    return re.sub(r"(?<![\w`-])(--?[a-z][a-z-]*[a-z])", r"`\1`", text)  # options


if __name__ == "__main__":
    print(page())
