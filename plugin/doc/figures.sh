#!/bin/sh
# Draws the figures of plugin/doc that have a gnuplot script: sh plugin/doc/figures.sh. The other SVG files
# are drawn by hand.
set -e
cd "$(dirname "$0")"
for script in *.gnuplot; do
  [ "$script" = style.gnuplot ] || gnuplot "$script"
done
