# Draws bond.svg: the force of fix bond/spring over its stretch in a harmonic motion e = E sin(w t) with E =
# 10 mm, w = 40 rad/s: an ellipse about the spring's line k e, whose area is the heat of one cycle, with k and
# c as in inputs/chain.
load "style.gnuplot"
set output "bond.svg"
k = 1e6
c = 1e4
E = 0.01
w = 40.0
F = 12.5
set samples 200
set xlabel "stretch e = r - L (mm)"
set ylabel "force F (kN), tension positive"
set xrange [-15:15]
set yrange [-18:18]
set xzeroaxis lw 1 lc rgb black
set yzeroaxis lw 1 lc rgb black
set key at graph 0.98,0.34
set label 1 "above the strength the bond breaks" at 14.5,14.2 right
set label 2 "stretch grows" at -5,4.5 right
set label 3 "stretch shrinks" at 5,-5 left
plot sample [0:1] '+' using (1e3*E*sin(2*pi*$1)):(1e-3*(k*E*sin(2*pi*$1) + c*E*w*cos(2*pi*$1))) \
       with lines lw 2.5 lc rgb black title "F = k e + c e'", \
     [-12:12] '+' using 1:(k*1e-6*$1) with lines lw 2 dt (8,5) lc rgb blue title "spring, k e", \
     [-15:15] '+' using 1:(F) with lines lw 1.6 dt (2,4) lc rgb black title "strength", \
     [-15:15] '+' using 1:(-F) with lines lw 1.6 dt (2,4) lc rgb black notitle
