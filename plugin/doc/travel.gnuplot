# Draws travel.svg: speed and place of fix drum/travel in the formulas of its page: from 0 to 2 m at 1 m/s,
# ramp 0.5, pause 0.5, two passes.
load "style.gnuplot"
set terminal svg size 640,420 font "sans-serif,13" background "white"
set output "travel.svg"
V = 1.0
L = 2.0
R = 0.5
P = 0.5
T = L/V + R
part(u) = u*u*(3 - 2*u)
way(u) = V*R*u**3*(1 - u/2)
speed(t) = t < 0 || t > T ? 0 : t < R ? V*part(t/R) : T - t < R ? V*part((T - t)/R) : V
place(t) = t < 0 ? 0 : t > T ? L : t < R ? way(t/R) : T - t < R ? L - way((T - t)/R) : V*(t - R/2)
set xrange [0:2*T+P]
set samples 600
set lmargin 9
set rmargin 3
set key off
set multiplot layout 2,1
set ylabel "speed (m/s)"
set yrange [-1.4:1.6]
set ytics 1
set label 1 "ramp" at R/2,1.25 center
set label 2 "ramp" at T-R/2,1.25 center
set label 3 "pause" at T+P/2,1.25 center
do for [n=1:3] { set arrow n from (n==1 ? R : n==2 ? T-R : T),graph 0 to (n==1 ? R : n==2 ? T-R : T),graph 1 \
  nohead dt (2,4) lc rgb grey }
set arrow 4 from T+P,graph 0 to T+P,graph 1 nohead dt (2,4) lc rgb grey
plot speed(x) - speed(x - T - P) with lines lw 2 lc rgb black
unset label
set ylabel "place (m)"
set xlabel "time (s)"
set yrange [-0.2:2.4]
set label 4 "pass 1" at T/2,2.1 center
set label 5 "pass 2" at 1.5*T+P,2.1 center
plot place(x) - place(x - T - P) with lines lw 2 lc rgb black
unset multiplot
