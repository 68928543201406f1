c a solution
v 10
1
5
