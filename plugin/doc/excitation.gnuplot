# Draws excitation.svg: the force and the frequency of fix drum/excite with a ramp and a sweep, in the
# formulas of its page: amplitude 58.8e3, frequency 10 (Hz), start 0.05, ramp 0.3, sweep to 30 Hz within 0.6
# s.
load "style.gnuplot"
set terminal svg size 640,480 font "sans-serif,13" background "white"
set output "excitation.svg"
Fw = 58.8
t0 = 0.05
tr = 0.3
f1 = 10.0
f2 = 30.0
T = 0.6
s(t) = t - t0
f(t) = s(t) <= 0 ? f1 : s(t) >= T ? f2 : f1 + (f2 - f1)*s(t)/T
phase(t) = 2*pi*(s(t) <= T ? (f1 + 0.5*(f2 - f1)*s(t)/T)*s(t) : f2*s(t) - 0.5*(f2 - f1)*T)
A(t) = s(t) < 0 ? 0 : s(t) < tr ? Fw*s(t)/tr : Fw
set xrange [0:0.8]
set samples 700
set lmargin 9
set rmargin 3
set multiplot layout 2,1
set arrow 1 from t0,graph 0 to t0,graph 1 nohead dt (2,4) lc rgb grey
set arrow 2 from t0+tr,graph 0 to t0+tr,graph 1 nohead dt (2,4) lc rgb grey
set arrow 3 from t0+T,graph 0 to t0+T,graph 1 nohead dt (2,4) lc rgb grey
set ylabel "Fe (kN)"
set yrange [-80:100]
set ytics 40
set label 1 "start" at 0.002,88 left
set label 2 "ramp" at t0+tr/2,88 center
set label 3 "end of the sweep" at t0+T-0.006,88 right
set key off
plot A(x)*sin(phase(x)) with lines lw 1.6 lc rgb black, A(x) with lines lw 1.6 dt (8,5) lc rgb blue, \
     -A(x) with lines lw 1.6 dt (8,5) lc rgb blue
unset label
set ylabel "frequency (Hz)"
set xlabel "time t (s)"
set yrange [0:40]
set ytics 10
set label 4 "sweep, linear in time" at 0.3,12 left
plot f(x) with lines lw 2 lc rgb black
unset multiplot
