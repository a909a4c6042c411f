// Pin with clearance in a plate, mm: the pin (body = 1), radius 5, touches the hole of the plate
// (body = 2), radius 5.02, at its lowest point.
//
//   for k in 1 2; do gmsh -2 -setnumber body $k pin.geo; done
DefineConstant[ body = {1, Choices{1, 2}} ];
Mesh.MshFileVersion = 2.2;
Mesh.ElementOrder = 2;
Mesh.Algorithm = 6;

hole = 5.02; pin = 5; wide = 20; up = 30; down = 18;
names[] = Str("pin", "plate");
If (body == 1)
   radius = pin; y = pin - hole; nodes = 31;
Else
   radius = hole; y = 0; nodes = 25;
EndIf
// Both lower quarters hold the contact, the upper half is free.
Point(1) = {0, y, 0, 1.5};
Point(2) = {0, y - radius, 0};
Point(3) = {radius, y, 0};
Point(4) = {0, y + radius, 0};
Point(5) = {-radius, y, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Transfinite Curve {1} = nodes Using Progression 1.02;
Transfinite Curve {4} = nodes Using Progression 1 / 1.02;
Transfinite Curve {2, 3} = 9;
Curve Loop(1) = {1:4};
If (body == 1)
   Plane Surface(1) = {1};
   Point{1} In Surface{1};
Else
   Point(6) = {-wide, -down, 0, 4};
   Point(7) = {wide, -down, 0, 4};
   Point(8) = {wide, up, 0, 4};
   Point(9) = {-wide, up, 0, 4};
   Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 9}; Line(9) = {9, 6};
   Curve Loop(2) = {6:9};
   Plane Surface(1) = {2, 1};
   Physical Curve("top", 3) = {8};
   Physical Curve("sides", 4) = {6, 7, 9};
EndIf
Physical Curve("bearing", 1) = {4, 1};
Physical Curve("free", 2) = {2, 3};
Physical Surface("steel", 1) = {1};
Mesh 2;
Save StrCat("pin_", names[body - 1], ".msh");
Exit;
