# Draws one frame of a force field as a heat map of the normal force with arrows of the shear.
# Variables: csv (of pillarfield solve), frame, rows, cols (pillars), pitch (mm), out (PNG).
set terminal pngcairo size 1000,860 font "DejaVu Sans,13" background "#ffffff"
set output out
set datafile separator ","
x(col) = (col - (cols - 1) / 2.0) * pitch
y(row) = ((rows - 1) / 2.0 - row) * pitch
half = pitch * 0.53  # a little overlap hides seams

set title "Force on a 10 x 10 cm patch of skin, per pillar" font ",15"
set xlabel "x, mm"
set ylabel "y, mm"
set cblabel "normal force, N"
set size ratio -1
set xrange [x(0) - half : x(cols - 1) + half]
set yrange [y(rows - 1) - half : y(0) + half]
set cbrange [0:*]
set tics out nomirror
set border lc "#555555"
unset key
# cividis, sampled
set palette defined (0 "#00224e", 1 "#123570", 2 "#3b496c", 3 "#575d6d", 4 "#707173", 5 "#8a8678", \
                     6 "#a59c74", 7 "#c3b369", 8 "#e1cc55", 9 "#fee838")
set object 1 rectangle from graph 0,0 to graph 1,1 fillcolor rgb "#00224e" behind

scale = 11.0  # mm of arrow per newton of shear
every3(row, col) = int(row) % 3 == 1 && int(col) % 3 == 1
shown(f) = int(f) == frame
ax(r, c, v) = shown($1) && every3(r, c) ? v : NaN
plot csv using (shown($1) ? x($4) : NaN):(y($3)):(half):(half):7 with boxxyerror fs solid noborder palette, \
     "" using (ax($3, $4, x($4))):(y($3)):(scale * $5):(scale * $6) \
        with vectors head size 1.6,22,60 filled lw 2.6 lc rgb "#000000", \
     "" using (ax($3, $4, x($4))):(y($3)):(scale * $5):(scale * $6) \
        with vectors head size 1.6,22,60 filled lw 1.2 lc rgb "#ffffff"
