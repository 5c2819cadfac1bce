#!/bin/sh
# Installs Pliant for one person without root, and removes it again.
set -eu

usage='usage: install.sh [--remove] [PREFIX]
Installs Pliant into PREFIX (~/.local by default), or removes it from there.'

action=install
prefix=${HOME:-}/.local
for word in "$@"; do
  case $word in
    --help | -h) printf '%s\n' "$usage"; exit 0 ;;
    --remove) action=remove ;;
    -*) printf 'install.sh: there is no option %s\n%s\n' "$word" "$usage" >&2; exit 2 ;;
    /*) prefix=$word ;;
    *) prefix=$PWD/$word ;;
  esac
done
case $prefix in
  *[!A-Za-z0-9/._\ +@~-]*)
    # Desktop entries quote other characters in ways that programs read differently.
    printf 'install.sh: %s has characters that a desktop entry cannot name; choose another prefix\n' "$prefix" >&2
    exit 1 ;;
esac

cd -- "$(dirname -- "$0")"

# Desktops read these indexes instead of the files.
refresh() {
  if [ -d "$prefix/share/mime/packages" ] && command -v update-mime-database >/dev/null; then
    update-mime-database "$prefix/share/mime"
  fi
  if [ -d "$prefix/share/applications" ] && command -v update-desktop-database >/dev/null; then
    update-desktop-database "$prefix/share/applications"
  fi
}

# A path as desktop entries have it. `xdg-open` finds no program in quotes, so only what needs them gets them.
quoted() { case $1 in *[\ ~]*) printf '"%s"' "$1" ;; *) printf '%s' "$1" ;; esac; }

has() { [ -n "$(find "$1" -name "$2" -type f 2>/dev/null | head -n 1)" ]; }

case $action in
  install)
    mkdir -p "$prefix"
    cp -R bin share "$prefix/"
    # The prefix may not be in PATH.
    entry=$prefix/share/applications/pliant.desktop
    sed -e "s|^Exec=pliant|Exec=$(quoted "$prefix/bin/pliant")|" -e "s|^TryExec=pliant|TryExec=$prefix/bin/pliant|" \
      share/applications/pliant.desktop >"$entry"
    refresh
    printf 'Pliant is installed: %s\nTo remove it: install.sh --remove %s\n' "$prefix/bin/pliant" "$prefix"
    ;;
  remove)
    find bin share -type f | while IFS= read -r file; do rm -f "$prefix/$file"; done
    refresh
    # Indexes of nothing would be left.
    has "$prefix/share/applications" '*.desktop' || rm -f "$prefix/share/applications/mimeinfo.cache"
    has "$prefix/share/mime/packages" '*.xml' || rm -rf "$prefix/share/mime"
    # Folders that others use are not empty, and stay.
    find bin share -depth -type d | while IFS= read -r folder; do
      rmdir "$prefix/$folder" 2>/dev/null || true
    done
    printf 'Pliant is removed from %s\n' "$prefix"
    ;;
esac
