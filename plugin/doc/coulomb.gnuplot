# Draws coulomb.svg: gnuplot coulomb.gnuplot. Columns: D, ratio with history at 72, 76, 80, 85 degrees, with coulomb at the same, of balls 1 to 4
# of tests/decks/oblique.scene (second-order stepping, B, mu = 0.5).
$ratio << END
0 1.0000 1.0000 1.0000 1.0000 1.0000 1.0000 1.0000 1.0000
0.05 1.0178 1.0143 1.0114 1.0094 1.0000 1.0000 1.0000 1.0000
0.1 1.0721 1.0592 1.0499 1.0436 1.0000 0.9999 1.0000 1.0001
0.15 1.1571 1.1351 1.1175 1.0994 0.9999 0.9999 1.0001 1.0001
0.2 1.2609 1.2383 1.2140 1.1892 0.9999 0.9999 1.0001 1.0002
0.3 1.4561 1.4845 1.4765 1.4463 0.9998 0.9998 1.0001 1.0003
0.4 1.5560 1.7245 1.7898 1.8079 0.9997 0.9997 1.0002 1.0004
0.5 1.5834 1.9064 2.1062 2.2538 0.9997 0.9996 1.0002 1.0006
0.6 1.6069 2.0308 2.3791 2.7342 0.9996 0.9995 1.0003 1.0007
0.7 1.6267 2.0680 2.5950 3.2391 0.9995 0.9994 1.0003 1.0009
0.8 1.6425 2.0951 2.7595 3.7202 0.9994 0.9993 1.0004 1.0010
0.9 1.6568 2.1187 2.8769 4.1590 0.9993 0.9992 1.0004 1.0012
1 1.6679 2.1383 2.9631 4.5452 0.9992 0.9991 1.0005 1.0013
1.25 1.6904 2.1757 3.0383 5.3010 0.9990 0.9988 1.0006 1.0017
1.5 1.7055 2.2019 3.0821 5.7472 0.9988 0.9985 1.0008 1.0021
1.75 1.7154 2.2190 3.1157 6.0234 0.9985 0.9983 1.0009 1.0025
2 1.7236 2.2321 3.1383 6.1891 0.9983 0.9980 1.0010 1.0028
END
set terminal svg size 640,400 font "sans-serif,13" background "white"
set output "coulomb.svg"
set xlabel "damping ratio D"
set ylabel "tangential over {/Symbol m} times normal impulse"
set key left top
set yrange [0:7]
set grid lc rgb "#dddddd"
plot for [n=1:4] $ratio using 1:(column(n+1)) with linespoints lw 1.5 pt 7 ps 0.4 lc n title "history, ".word("72 76 80 85", n)." degrees", \
     for [n=1:4] $ratio using 1:(column(n+5)) with lines lw 2 lc rgb "black" title n == 1 ? "coulomb, all four" : ""
