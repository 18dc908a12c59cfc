# A row of the table bed of observe, from balls at rest, at the end and at the largest force, and contacts at
# rest and at the largest force. Balls are lines of x y z radius type in the order of their IDs, y up;
# contacts lines of two IDs and the force on the first ball. Stress is the sum of force times branch over the
# area of a cell, each branch in ten pieces; compression is positive. A cell is given by the distance from the
# axis of the drum and the depth below its lowest point.

FNR == 1 { ++file }
file <= 3 { x[file, FNR] = $1; y[file, FNR] = $2; r[file, FNR] = $4; type[FNR] = $5; count = FNR
  if ($5 == 2) { axis[file] = $1; bottom[file] = $2 - $4 }
  next }
FNR == 1 { entries = 0 }
/^ITEM: ENTRIES/ { entries = 1; next }
entries && type[$1] == 1 && type[$2] == 1 { branch($1, $2, $3, $4, file == 4 ? 1 : 3) }
entries && file == 5 && ((type[$1] == 1 && type[$2] == 2) || (type[$1] == 2 && type[$2] == 1)) {
  force += $4 > 0 ? $4 : -$4
}

# Adds the contact of balls a and b of the soil to the cells that its branch crosses, or at rest takes it off.
function branch(a, b, fx, fy, state,   lx, ly, piece, px, depth, cell, sign) {
  lx = x[state, b] - x[state, a]; ly = y[state, b] - y[state, a]
  sign = state == 1 ? -1 : 1
  for (piece = 0.05; piece < 1; piece += 0.1) {
    px = x[state, a] + piece * lx - axis[3]
    if (px < 0) px = -px
    depth = bottom[3] - y[state, a] - piece * ly
    if (px < 0.2 && depth > 0.1 && depth < 0.9) {
      cell = int((depth - 0.1) / 0.2)
      below[cell] -= sign * fy * ly / 10 / (0.4 * 0.2)
    }
    if (px > 0.4 && px < 1.6 && depth > 0.05 && depth < 0.4) {
      cell = int((px - 0.4) / 0.4)
      horizontal[cell] -= sign * fx * lx / 10 / (0.8 * 0.35)
      vertical[cell] -= sign * fy * ly / 10 / (0.8 * 0.35)
    }
  }
}

# Height of the soil's surface in the column of 0.1 m from left on.
function surface(state, left,   i, nearest, d, height, top) {
  for (i = 1; i <= count; ++i) {
    if (type[i] != 1) continue
    nearest = x[state, i] < left ? left : x[state, i] > left + 0.1 ? left + 0.1 : x[state, i]
    d = x[state, i] - nearest
    if (d * d >= r[state, i] ^ 2) continue
    height = y[state, i] + sqrt(r[state, i] ^ 2 - d * d)
    if (height > top) top = height
  }
  return top
}

# Mean rise of the columns on both sides of the drum, in mm.
function rise(from, to,   k, side, left, sum, columns, n) {
  n = int((to - from) / 0.1 + 0.5)
  for (k = 0; k < n; ++k)
    for (side = 0; side < 2; ++side) {
      left = axis[1] + (side ? from + 0.1 * k : -from - 0.1 * (k + 1))
      if (surface(1, left) == "" || surface(2, left) == "") continue
      sum += surface(2, left) - surface(1, left)
      ++columns
    }
  return columns ? sprintf("%.2f", 1e3 * sum / columns) : ""
}

END {
  printf "%s,%s,%s,%s,%.1f", seed, rise(0.2, 0.5), rise(0.5, 0.8), rise(0.8, 1.2), force / 1e3
  for (i = 0; i < 4; ++i) printf ",%.1f", below[i] / 1e3
  for (i = 0; i < 3; ++i) printf ",%.2f,%.2f", horizontal[i] / 1e3, vertical[i] / 1e3
  print ""
}
