#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Sets up what is missing and makes the documentation: build/docs/html/index.html and build/docs/masonry.pdf.
# Packages come from Debian (500 MB, of which chromium, which prints the PDF, is 350); nothing else is fetched.
#
#   bash scripts/docs.sh
#   bash scripts/docs.sh --no-pdf      the site alone, for which chromium is not needed
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(python3-sphinx python3-myst-parser furo libjs-mathjax python3-yaml python3-nbclient python3-ipykernel)
[[ " $* " == *" --no-pdf "* ]] || packages+=(chromium)
bash scripts/setup.sh --with "${packages[@]}"
exec /usr/bin/python3 scripts/docs/build.py "$@"
