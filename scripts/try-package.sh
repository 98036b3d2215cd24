#!/bin/sh
# Installs a Debian package (cpack -G DEB) in a clean Debian of this machine's own package sources, and renders there.
#   scripts/try-package.sh PACKAGE.deb [SCENE.json]        needs mmdebstrap, and root or user namespaces
set -e
package=$(realpath "$1")
scene=$(realpath "${2:-$(dirname "$0")/../data/scenes/cornell-fog/scene.json}")
sources=$(ls /etc/apt/sources.list /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list 2>/dev/null || true)
mmdebstrap --quiet --variant=apt --format=null \
    --customize-hook="copy-in $package $scene /tmp" \
    --customize-hook="chroot \"\$1\" apt-get install -y -qq --no-install-recommends /tmp/$(basename "$package")" \
    --customize-hook="chroot \"\$1\" tungsten --resolution 32x32 --spp 1 --quiet -d /tmp/out -o image.png -e film.npz /tmp/$(basename "$scene")" \
    --customize-hook="chroot \"\$1\" python3 -c 'import numpy, darts_tungsten.tools as t; print(\"python:\", numpy.load(\"/tmp/out/film.npz\")[\"mean\"].shape)'" \
    --customize-hook="chroot \"\$1\" ls /usr/share/man/man1/tungsten.1 /usr/share/bash-completion/completions/tungsten /tmp/out" \
    "" /dev/null $sources
