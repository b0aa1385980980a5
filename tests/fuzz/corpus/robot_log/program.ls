/PROG  WORK
/POS
P[1:"home"]{
 GP1:
 UF : 0, UT : 1,
 J1= 6.2 deg, J2= -1 deg, J3= 2 deg, J4= -.2 deg, J5= 5 deg, J6= 6 deg
};
P[2]{
 GP1:
 X = 1.0 mm
};
/END
