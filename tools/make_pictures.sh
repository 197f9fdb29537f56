#!/usr/bin/env bash
# Makes the pictures and the film of the documentation again, under docs/images.
#
#   tools/make_pictures.sh                 all of them (hours: it runs whole demonstrations)
#   tools/make_pictures.sh NAME...         some: film, windows, calot, ... (--list names them)
#
# Uses build/release/trocar; windows are drawn on a display of their own (Xvfb), so none has to be there.
# Exit: 0 made, 1 a picture failed, 2 unknown name, 77 Xvfb, xdotool, ffmpeg or PIL is missing.
set -euo pipefail
cd "$(dirname "$0")/.."
[ -x build/release/trocar ] || { echo "make_pictures: build the program first: ./run.sh build" >&2; exit 2; }
python=
for candidate in python3 /usr/bin/python3; do  # Debian's own has python3-pil
  if $candidate -c 'import PIL' 2>/dev/null; then python=$candidate; break; fi
done
[ -n "$python" ] || { echo "make_pictures: python3-pil is missing: tools/setup.sh test" >&2; exit 77; }
if [ "${1:-}" = --list ]; then exec $python tools/make_pictures.py --list; fi
for tool in Xvfb xdotool ffmpeg; do
  command -v $tool >/dev/null || { echo "make_pictures: $tool is missing: tools/setup.sh test" >&2; exit 77; }
done
case " ${*:-windows} " in  # only windows need a display
  *' windows '*) exec tools/with_xvfb.sh 1280x720 $python tools/make_pictures.py "$@" ;;
  *) exec $python tools/make_pictures.py "$@" ;;
esac
