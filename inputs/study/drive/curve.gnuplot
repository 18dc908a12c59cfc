# Draws curve.svg: gnuplot curve.gnuplot, in this folder, from the beds "study, SOIL, seed N" of passes.csv.
# Bars: 95 % intervals of the mean of five beds.
load "../../../plugin/doc/style.gnuplot"
set terminal svg size 820,400 font "sans-serif,13" background "white"
set output "curve.svg"
set datafile separator ","
t = 2.776 # Student's distribution with four degrees of freedom, 95 % on both sides
beds(soil) = sprintf("< grep '^.study, %s, seed' passes.csv", soil)
set print $curves
do for [soil in "base gravel dense"] {
  do for [pass = 0:8] {
    stats beds(soil) using ($2 == pass ? $9 : NaN) name "lift" nooutput
    stats beds(soil) using ($2 == pass ? $8 : NaN) name "below" nooutput
    print sprintf("%d,%.6f,%.6f,%.6f,%.6f", pass, lift_mean, t * lift_ssd / sqrt(lift_records), \
                  below_mean, t * below_ssd / sqrt(below_records))
  }
  print ""
  print ""
}
unset print
set multiplot layout 1,2
set xlabel "passes"
set ylabel "solid fraction [-]"
set xrange [-0.4:8.4]
set xtics 0,1,8
set key below
set format y "%.2f"
array names[3] = ["base course, loose", "gravel, loose", "base course, dense"]
array colours[3] = [black, blue, grey]
do for [layer = 0:1] {
  set title layer == 0 ? "The lift" : "The dense soil below it"
  set ytics layer == 0 ? 0.02 : 0.01
  mean = 2 + 2 * layer
  plot for [n = 1:3] $curves index n - 1 using ($1 + 0.12 * (n - 2)):mean:mean + 1 with yerrorlines \
       lc rgb colours[n] dt n pt 3 + 2 * n ps 0.6 title names[n]
}
unset multiplot
