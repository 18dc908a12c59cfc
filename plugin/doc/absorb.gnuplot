# Draws absorb.svg. Points: w H/c_p and the reflected share of the energy of waves on a chain, from
# tests/decks/absorb_test.cpp (31 balls a wavelength, second-order stepping).
$measured << END
0.1 0.9610
0.2 0.8579
0.35 0.6565
0.5 0.4758
0.75 0.2767
1 0.1693
1.5 0.0748
2 0.0387
END
load "style.gnuplot"
set output "absorb.svg"
set samples 400
set xrange [0:2.2]
set yrange [0:1.05]
set xlabel "{/Symbol w} H / c_p"
set ylabel "reflected share of the energy"
set key right top
theta = 0.2 # from ball to ball
w = 2*sin(theta/2) # times sqrt(m/k)
q(x) = w/x - 1 + cos(theta)
chain(x) = (q(x)**2 + (sin(theta) - w)**2)/(q(x)**2 + (sin(theta) + w)**2)
plot 1/(1 + 4*x*x) with lines lw 2 lc rgb black title "continuum, 1/(1 + (2 {/Symbol w} H/c_p)^2)", \
     [0.001:2.2] chain(x) with lines lw 1.5 dt (8,5) lc rgb blue title "chain of balls, exact", \
     $measured using 1:2 with points pt 7 ps 0.8 lc rgb blue title "measured on a chain of balls"
