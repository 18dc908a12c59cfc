# Draws relation.svg: gnuplot relation.gnuplot, in this folder, from relation.csv.
load "../../../plugin/doc/style.gnuplot"
set terminal svg size 560,440 font "sans-serif,13" background "white"
set output "relation.svg"
set datafile separator ","
f(x) = a + b * x
a = 2
b = 0.6
set fit quiet
set fit nolog
fit f(x) "relation.csv" every ::1 using ($4 > 10 ? log($4) : NaN):(log($5)) via a, b
set logscale xy
set xlabel "E_{v2} of the plate load test [MPa]"
set ylabel "k that the roller feels [MN/m per m of width]"
set xrange [10:400]
set yrange [10:400]
set xtics (10, 20, 50, 100, 200, 400)
set ytics (10, 20, 50, 100, 200, 400)
set key top left
soils = "soft base stiff loose dry gravel"
beds(soil) = sprintf("< grep '^%s,' relation.csv", soil)
plot for [n = 1:6] beds(word(soils, n)) using 4:5 with points pt (n < 6 ? 3 + 2 * n : 6) ps 0.8 lc rgb black \
       title word(soils, n), \
     exp(f(log(x))) with lines lc rgb blue title sprintf("E_{v2} to the power %.2f", b)
