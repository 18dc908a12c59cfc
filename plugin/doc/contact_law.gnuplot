# Draws contact_law.svg: the contact force over the overlap in one impact, in dimensionless form. The overlap
# of an impact at the speed v on a spring k with the damping ratio D, in units of v/w0 with w0 = sqrt(k/m), is
# d(t) = exp(-D t) sin(s t)/s, s = sqrt(1 - D^2), t in units of 1/w0; the force is k d + c d' = d + 2 D d' in
# units of k v/w0.
load "style.gnuplot"
set output "contact_law.svg"
D = 0.3
s = sqrt(1 - D**2)
d(t) = exp(-D*t)*sin(s*t)/s
rate(t) = exp(-D*t)*(cos(s*t) - D/s*sin(s*t))
F(t) = d(t) + 2*D*rate(t)
t_open = pi/s                              # d = 0: the end of the contact under A
t_zero = (pi - atan2(2*D*s, 1 - 2*D**2))/s # F = 0: its end under B
set xlabel "overlap d  (in v/w0)"
set ylabel "contact force Fc  (in k v/w0)"
set xrange [-0.1:0.8]
set yrange [-0.5:1.05]
set xzeroaxis lw 1 lc rgb black
set yzeroaxis lw 1 lc rgb black
set key bottom right
set samples 200
set label 1 "make: the force jumps to c d'" at 0.02,0.5 left
set label 2 "approach" at 0.3,0.84 center
set label 3 "rebound" at 0.5,0.2 left
set label 4 "B: break at Fc = 0" at d(t_zero)+0.03,-0.06 left
set label 5 "A: break at d = 0, in tension" at 0.03,F(t_open)-0.02 left
plot sample [0:1] '+' using (0):(2*D*$1) with lines lw 2.5 lc rgb black notitle, [0:1] \
     '+' using (d($1*t_zero)):(F($1*t_zero)) with lines lw 2.5 lc rgb black title "A and B", [0:1] \
     '+' using (d(t_zero+$1*(t_open-t_zero))):(F(t_zero+$1*(t_open-t_zero))) \
       with lines lw 2.5 dt (8,5) lc rgb blue title "A", [0:1] \
     '+' using (d(t_zero)*$1):(0) with lines lw 4 dt (2,4) lc rgb black title "B: no tension"
