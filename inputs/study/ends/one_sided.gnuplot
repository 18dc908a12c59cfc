# Draws one_sided.svg: gnuplot one_sided.gnuplot, in this folder, from runs.csv and from chain.csv of
#   ./drumlin exact --roller inputs/rollers/Axas2020 --contacts soil.csv --cycles 400 --samples-per-cycle 100
# with k = 45 MN/m, left over right 1.5 (27 and 18 MN/m at -+0.6149 m), c in the same ratio.
load "../../../plugin/doc/style.gnuplot"
set terminal svg size 900,380 font "sans-serif,13" background "white"
set output "one_sided.svg"
set datafile separator ","
set multiplot layout 1,2
set logscale x 2
set xlabel "stiffness of the left half over that of the right"
set ylabel "apparent stiffness k_1 [MN/m]"
set title "Soil of 15 MN/m"
set yrange [0:30]
set key top center
plot "runs.csv" using 2:($1 == 15 ? $3 : NaN) with linespoints lc rgb black dt 1 pt 7 title "sensor at the left end", \
     "" using 2:($1 == 15 ? $5 : NaN) with linespoints lc rgb blue dt 2 pt 5 title "at the right end", \
     "" using 2:($1 == 15 ? $4 : NaN) with lines lc rgb grey dt 4 lw 2 title "in the middle"
unset logscale x
set yrange [*:*]
set xlabel "cycles"
set ylabel "height of the drum [mm]"
set title "Soil of 27 (left) and 18 MN/m (right)"
set xrange [0:4]
set key top right
f = 29.0
plot "chain.csv" using ($1 * f - 396):($1 * f >= 396 - 1e-9 ? 1e3 * ($2 - 1.065 * $11) : NaN) \
       with lines lc rgb black dt 1 title "left end", \
     "" using ($1 * f - 396):($1 * f >= 396 - 1e-9 ? 1e3 * ($2 + 1.065 * $11) : NaN) \
       with lines lc rgb blue dt 2 title "right end"
unset multiplot
