#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Makes a Debian source package of the last commit, and of it the binary package for the release that it runs on, both in
# build/package. The binary package depends on exactly the YADE that is installed here, because the plugin fits no other.
#
#   bash scripts/package.sh
#   bash scripts/package.sh --source                            the source package alone
#   bash scripts/package.sh FOLDER/yade-masonry_VERSION.dsc     the binary package of a source package made elsewhere
#   apt-get install ./build/package/yade-masonry_*.deb          on each machine, as root
#   apt-get remove yade-masonry
#
# The maintainer's name and address are DEBFULLNAME and DEBEMAIL, else those of the last commit. DEB_BUILD_OPTIONS=nocheck
# leaves the tests of C++ out. A copy of the plugin that setup.sh has installed stands before the package in Python's path:
# remove it where both are.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out=$PWD/build/package
source=
[[ -z ${1:-} || $1 == --source ]] || source=$(realpath "$1")
command -v dpkg-source >/dev/null || { echo "needs dpkg-dev: apt-get install dpkg-dev" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [[ -z $source ]]; then
    number=$(sed -n 's/^__version__ = "\(.*\)"$/\1/p' scripts/masonry/__init__.py)
    version=$number+git$(TZ=UTC git log -1 --date=format-local:%Y%m%d.%H%M --format=%cd.%h --abbrev=8)+ds
    maintainer="${DEBFULLNAME:-$(git log -1 --format=%an)} <${DEBEMAIL:-$(git log -1 --format=%ae)}>"
    rm -rf "$out"
    mkdir -p "$out"
    tree=$work/yade-masonry-$version
    git archive --prefix="yade-masonry-$version/" HEAD . ':!validation' | xz >"$out/yade-masonry_$version.orig.tar.xz"
    tar -C "$work" -xf "$out/yade-masonry_$version.orig.tar.xz"
    cp -r "$tree/scripts/debian" "$tree/debian"
    cat - scripts/debian/changelog >"$tree/debian/changelog" <<CHANGELOG
yade-masonry ($version-1) UNRELEASED; urgency=medium

  * $(git log -1 --format='Commit %H.')

 -- @MAINTAINER@  $(git log -1 --format=%cD)

CHANGELOG
    sed -i "s/@MAINTAINER@/$maintainer/" "$tree/debian/control" "$tree/debian/changelog"
    (cd "$out" && dpkg-source --build "$tree" >log)
    source=$out/yade-masonry_$version-1.dsc
    ls "$source"
    [[ ${1:-} != --source ]] || exit 0
fi

# A later release gets a later version of the same source: ~deb12, ~deb13, ~debforky; testing has no number.
mkdir -p "$out"
dpkg-source --extract "$source" "$work/source" >>"$out/log" 2>&1
cd "$work/source"
release=$(. /etc/os-release && echo "${VERSION_ID:-$VERSION_CODENAME}")
sed -i "1s/)/~deb$release)/" debian/changelog
dpkg-checkbuilddeps || { echo "as root: apt-get build-dep --no-install-recommends $source" >&2; exit 1; }
# The package for debuggers is not kept, so compilers need not write what it would have: two fifths of the time.
export DEB_CXXFLAGS_STRIP=-g
dpkg-buildpackage --build=binary --no-sign --jobs=auto >>"$out/log" 2>&1 || { tail -n 40 "$out/log" >&2; exit 1; }
mv ../yade-masonry_*.deb "$out"
ls "$out"/*.deb
