# The style of all figures of this folder; loaded by each *.gnuplot file. Lines differ by their dashes, so
# that no colour vision is needed.
set terminal svg size 640,400 font "sans-serif,13" background "white"
set grid lc rgb "#dddddd"
set border lw 1
black = "#000000"
blue = "#0060a8"
grey = "#808080"
