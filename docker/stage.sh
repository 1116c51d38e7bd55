#!/usr/bin/env bash
# Copies what the program needs to run into a folder: program, drivers, shared files, shared libraries.
# Usage: docker/stage.sh FOLDER   (after a release build)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
to=${1:?usage: docker/stage.sh FOLDER}
built=build/release

mkdir -p "$to/bin" "$to/lib" "$to/share/kinectlab"
cp "$built/bin/kinectlab" "$to/bin/"
cp -rL "$built/lib/openni2" "$to/lib/"
for folder in experiments migrations web; do cp -rL "$built/share/kinectlab/$folder" "$to/share/kinectlab/"; done

# libc and its family come with every Debian; everything else travels along, beside OpenNI2 where RPATH looks.
ldd "$to/bin/kinectlab" "$to"/lib/openni2/OpenNI2/Drivers/*.so.0 |
  awk '$2 == "=>" && $3 ~ /^\// {print $3}' | sort -u |
  grep -vE '/(libc|libm|libdl|libpthread|librt|ld-linux[^/]*|libOpenNI2)\.so' |
  xargs -I{} cp -L {} "$to/lib/openni2/"
