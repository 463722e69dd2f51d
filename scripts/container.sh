#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Builds the image "masonry" of this working tree with podman, buildah or docker, whichever is there first, and runs the
# couplet in it on a temporary folder. Prints the size of the image and both times.
#
#   bash scripts/container.sh
#   BASE=localhost/debian:bookworm bash scripts/container.sh     from another image of Debian 12 or 13
#   ROOTFS=debian.tar bash scripts/container.sh                  from an archive that debootstrap made, without a registry:
#       debootstrap --variant=minbase bookworm debian && tar -C debian -cf debian.tar .
#   OPTIONS="--storage-driver vfs" BUILD_OPTIONS="--isolation chroot" bash scripts/container.sh
#       options of the tool, and of its build; these are for a machine on which it may mount nothing
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
tool=$(command -v podman buildah docker | head -n 1 | xargs -r basename) || true
[[ -n $tool ]] || { echo "needs podman, buildah or docker: apt-get install --no-install-recommends podman" >&2; exit 1; }
read -ra options <<<"${OPTIONS:-}"
read -ra buildOptions <<<"${BUILD_OPTIONS:-}"
tools=("$tool" "${options[@]}")

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git ls-files -z --cached --others --exclude-standard | tar -c --null --files-from=- | (mkdir "$work/tree" && tar -x -C "$work/tree")
if [[ -n ${ROOTFS:-} ]]; then
    BASE=localhost/masonry-base
    mkdir "$work/base"
    cp "$ROOTFS" "$work/base/rootfs.tar"
    printf 'FROM scratch\nADD rootfs.tar /\n' >"$work/base/Containerfile"
    "${tools[@]}" build "${buildOptions[@]}" -q -t "$BASE" -f "$work/base/Containerfile" "$work/base" >/dev/null
fi
started=$SECONDS
"${tools[@]}" build "${buildOptions[@]}" ${BASE:+--build-arg BASE="$BASE"} -t masonry -f "$work/tree/scripts/Containerfile" "$work/tree"
echo "built in $((SECONDS - started)) s"
"${tools[@]}" images masonry

mkdir "$work/run"
started=$SECONDS
if [[ $tool == buildah ]]; then # it has no run of an image, but one of a container that is made from it
    container=$("${tools[@]}" from masonry)
    "${tools[@]}" run "${buildOptions[@]}" -v "$work/run:/work" "$container" -- bash /usr/local/bin/masonry couplet --quick
    "${tools[@]}" rm "$container" >/dev/null
else
    "${tools[@]}" run --rm --network none -v "$work/run:/work" masonry couplet --quick
fi
echo "ran the couplet in $((SECONDS - started)) s; it left, for user $(stat -c %U "$work/run/results/couplet/run.json"):"
ls -l "$work/run/results/couplet"
