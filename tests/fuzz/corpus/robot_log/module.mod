MODULE W
! jointtarget j0
CONST jointtarget j1:=[[10,-20.5,30,40,50,60],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p1:=[[1,2,3]];
ENDMODULE
jointtarget j2 = j:{1,2,3,4,5,6}{EJ 0}
