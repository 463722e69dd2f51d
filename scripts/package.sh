#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Makes a Debian package of the plugin for the release that it runs on: build/package/yade-masonry_VERSION_ARCH.deb.
# It depends on exactly the YADE that is installed here, because the plugin fits no other.
#
#   bash scripts/package.sh
#   apt-get install ./build/package/yade-masonry_*.deb     on each machine, as root
#   apt-get remove yade-masonry
#
# The maintainer's name and address are those of git, or of DEBFULLNAME and DEBEMAIL. A copy of the plugin that setup.sh
# has installed stands before the package in Python's path: remove it where both are.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

for tool in dpkg-shlibdeps dpkg-deb cmake; do
    command -v "$tool" >/dev/null || { echo "needs $tool: apt-get install dpkg-dev cmake" >&2; exit 1; }
done
yade=$(dpkg-query -W -f '${Version}' yade 2>/dev/null) || { echo "needs yade: bash scripts/setup.sh installs it" >&2; exit 1; }
name=${DEBFULLNAME:-$(git config user.name || true)}
address=${DEBEMAIL:-$(git config user.email || true)}
[[ -n $name && -n $address ]] || { echo "set DEBFULLNAME and DEBEMAIL to the maintainer's name and address" >&2; exit 1; }

number=$(sed -n 's/^__version__ = "\(.*\)"$/\1/p' scripts/masonry/__init__.py)
commit=$(git describe --always --dirty 2>/dev/null || echo unknown)
date=$(git log -1 --format=%ct 2>/dev/null || date +%s)
python=$(/usr/bin/python3 -c 'import sys; print(f"{sys.version_info[0]}.{sys.version_info[1]}")')
next=${python%.*}.$((${python#*.} + 1))
architecture=$(dpkg --print-architecture)
release=$(. /etc/os-release && echo "$VERSION_ID")
version=$number+$(date -u -d "@$date" +%Y%m%d)~deb$release

out=build/package
root=$out/root
rm -rf "$out"
mkdir -p "$root/DEBIAN" "$root/usr/share/doc/yade-masonry"
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DMASONRY_TESTS=OFF -DMASONRY_COMMIT="$commit" >"$out/log" 2>&1 &&
    cmake --build build --parallel "$(nproc)" --target masonry_module_fit >>"$out/log" 2>&1 || { tail -n 40 "$out/log" >&2; exit 1; }
packages=$root/usr/lib/python3/dist-packages
package=$packages/masonry
mkdir -p "$packages"
(cd scripts && find masonry masonry_* \( -name '*.py' -o -name '*.js' -o -name '*.css' -o -name '*.html' -o -name py.typed \) -print0 | tar -c --null --files-from=-) | tar -x --no-same-owner --no-same-permissions -C "$packages"
install -m 644 build/_masonry.so "$package/"
strip --strip-unneeded --remove-section=.comment --remove-section=.note "$package/_masonry.so"

# The libraries that the module needs, by the packages of this release.
mkdir -p "$out/debian"
printf 'Source: yade-masonry\n\nPackage: yade-masonry\nArchitecture: any\n' >"$out/debian/control"
libraries=$(cd "$out" && dpkg-shlibdeps --ignore-missing-info -O -e"root/usr/lib/python3/dist-packages/masonry/_masonry.so" 2>>log | sed 's/^shlibs:Depends=//')

cat >"$root/DEBIAN/control" <<CONTROL
Package: yade-masonry
Version: $version
Architecture: $architecture
Maintainer: $name <$address>
Installed-Size: $(du -sk "$root/usr" | cut -f 1)
Depends: yade (= $yade), python3 (>= $python), python3 (<< $next), python3-jinja2, python3-matplotlib, python3-meshio, python3-numpy, python3-scipy, coinor-libclp1, $libraries
Recommends: python3-ezdxf, python3-svgelements
Suggests: libjs-three, python3-openturns, slurm-client
Section: science
Priority: optional
Description: masonry walls of blocks and joints in the discrete element code YADE
 A plugin of YADE that simulates how unreinforced masonry walls crack, slide and
 crush, brick by brick. Joints follow a published law with softening in tension
 and shear and with crushing. Python scripts describe walls, arches, vaults and
 what is done to them.
 .
 After the installation plain "yade" can "import masonry".
CONTROL
cat >"$root/usr/share/doc/yade-masonry/copyright" <<COPYRIGHT
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: masonry for YADE

Files: *
Copyright: $(date -u -d "@$date" +%Y) $name
License: GPL-2+
 This program is free software; you can redistribute it and/or modify it under the terms of the GNU General Public
 License as published by the Free Software Foundation; either version 2 of the License, or (at your option) any later
 version. On Debian systems the full text of version 2 is in /usr/share/common-licenses/GPL-2.
COPYRIGHT
gzip -9n >"$root/usr/share/doc/yade-masonry/changelog.gz" <<CHANGELOG
yade-masonry ($version) unstable; urgency=medium

  * Made by scripts/package.sh from commit $commit for YADE $yade.

 -- $name <$address>  $(LC_ALL=C date -u -R -d "@$date")
CHANGELOG
# Compiled modules are made and removed as those of all Debian's Python packages are.
cat >"$root/DEBIAN/postinst" <<'POSTINST'
#!/bin/sh
set -e
if command -v py3compile >/dev/null 2>&1; then
    py3compile -p yade-masonry
fi
POSTINST
cat >"$root/DEBIAN/prerm" <<'PRERM'
#!/bin/sh
set -e
if command -v py3clean >/dev/null 2>&1; then
    py3clean -p yade-masonry
fi
PRERM
chmod 755 "$root/DEBIAN/postinst" "$root/DEBIAN/prerm"
(cd "$root" && find usr -type f -print0 | sort -z | xargs -0 md5sum >DEBIAN/md5sums)
find "$root/usr" -type d -exec chmod 755 {} + -o -type f -exec chmod 644 {} +
chmod 644 "$root/DEBIAN/control" "$root/DEBIAN/md5sums"
dpkg-deb --root-owner-group --build "$root" "$out" >>"$out/log"
rm -rf "$root" "$out/debian"
ls "$out"/*.deb
