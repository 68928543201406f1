* minimises the negated value of a labeling problem
NAME labeling FREE
ROWS
 N value
 L x1
 L x2
 L x3
 L y4
 L y5
 L y6
 L y7
 L r8
 G r9
 E r10
 L r11
COLUMNS
 M1 'MARKER' 'INTORG'
 b1 value -7
 b1 x1 1
 b1 x2 1
 b1 y4 -1
 b1 r8 1
 b1 r10 1
 b1 r11 2
 b2 value -5
 b2 x1 1
 b2 x3 1
 b2 y6 -1
 b2 r8 1
 b2 r9 -1
 b2 r10 1
 b3 value 2
 b3 x3 1
 b3 y5 -1
 b3 r8 1
 b4 value 0
 b4 y7 -1
 b4 r8 -1
 b4 r9 1
 b5 value -9
 b5 x2 1
 b5 r10 1
 b5 r11 3
 M2 'MARKER' 'INTEND'
 y1_3 value -4
 y1_3 y4 1
 y1_3 y5 1
 y2_4 value -12
 y2_4 y6 1
 y2_4 y7 1
RHS
 RHS x1 1
 RHS x2 1
 RHS x3 1
 RHS r8 2
 RHS r10 1
 RHS r11 5
BOUNDS
 BV BND b1
 BV BND b2
 BV BND b3
 BV BND b4
 BV BND b5
 UP BND y1_3 1
 UP BND y2_4 1
ENDATA
