#!/bin/sh
# Draws docs/terminal.svg: vdb_tet at work on a sequence, and its closing table, as a terminal shows them. Needs
# tmux, python3, and a build with the tests.
#
# usage: tools/make_terminal_picture.sh [BUILD]   (default: build/release)
set -eu
cd "$(dirname "$0")/.."
build=$(realpath "${1:-build/release}")
svg=$PWD/docs/terminal.svg

folder=$(mktemp -d)
session=vdbtet-$$
trap 'tmux -L "$session" kill-server 2>/dev/null || true; rm -rf "$folder"' EXIT
cd "$folder"
"$build/tests/cli/vdbtet_cli_fixtures" --sequence
for frame in frame.00*.vdb; do mv "$frame" "drops.${frame#frame.}"; done
mkdir out
tmux -L "$session" -f /dev/null new-session -d -x 100 -y 40 "env PS1='\$ ' PATH='$build/tools:$PATH' sh"
tmux -L "$session" set-option -g status off
command="vdb_tet drops.%04d.vdb 'out/{frame}.vtu' --frames 1-12 -v 0.1"
tmux -L "$session" send-keys "clear; $command" Enter
until tmux -L "$session" capture-pane -p >pane && grep -q 'left$' pane; do sleep 0.05; done
grep 'left$' pane >live
until tmux -L "$session" capture-pane -p >pane && grep -q '^[0-9]* written' pane; do sleep 0.2; done

python3 - pane live "$command" "$svg" <<'END'
import html
import sys

pane, live = ([line.rstrip() for line in open(name)] for name in sys.argv[1:3])
end = next(i for i, line in enumerate(pane) if " written" in line and " in " in line)
lines = ["$ " + sys.argv[3], *live[-1:], *pane[:end + 1]]
width, height = 20 + 8.43 * max(map(len, lines)), 24 + 19 * len(lines)
with open(sys.argv[4], "w") as svg:
    svg.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height}" '
              'font-family="monospace" font-size="14" fill="#d8d8d8">\n'
              '<rect width="100%" height="100%" rx="6" fill="#1e1e1e"/>\n')
    for i, line in enumerate(lines):
        svg.write(f'<text x="10" y="{26 + 19 * i}" xml:space="preserve">{html.escape(line)}</text>\n')
    svg.write("</svg>\n")
END
