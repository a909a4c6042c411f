// Half of a cylinder of radius 50 (body = 1) on half of a block of 200 x 200 (body = 2), mm: NAFEMS
// R0094-1, Code_Aster's SSNP154 (docs/verification.md). x = 0 is a plane of symmetry.
//
//   for k in 1 2; do gmsh -2 -setnumber body $k SSNP154.geo; done
DefineConstant[ body = {1, Choices{1, 2}} ];
Mesh.MshFileVersion = 2.2;
Mesh.ElementOrder = 2;
Mesh.Algorithm = 6;

radius = 50; wide = 100; high = 200;
near = 9; // the contact has a half-width of 6.2
names[] = Str("cylinder", "block");
If (body == 1)
   // The load acts on the arc from 4 to 5 at the top.
   Point(1) = {0, radius, 0, 15};
   Point(2) = {0, 0, 0, 0.3};
   Point(3) = {near, radius - Sqrt(radius^2 - near^2), 0, 0.3};
   Point(4) = {4, radius + Sqrt(radius^2 - 4^2), 0, 4};
   Point(5) = {0, 2 * radius, 0, 4};
   Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5};
   Line(4) = {5, 1}; Line(5) = {1, 2};
   Transfinite Curve {1} = 31;
   Curve Loop(1) = {1:5};
   Physical Curve("contact", 1) = {1};
   Physical Curve("top", 2) = {3};
   Physical Curve("symmetry", 3) = {4, 5};
   Physical Curve("free", 4) = {2};
Else
   Point(2) = {0, 0, 0, 0.3};
   Point(3) = {near, 0, 0, 0.25};
   Point(4) = {wide, 0, 0, 12};
   Point(5) = {wide, -high, 0, 20};
   Point(6) = {0, -high, 0, 20};
   Line(1) = {2, 6}; Line(2) = {6, 5}; Line(3) = {5, 4}; Line(4) = {4, 3}; Line(5) = {3, 2};
   Transfinite Curve {5} = 37;
   Curve Loop(1) = {1:5};
   Physical Curve("contact", 1) = {5};
   Physical Curve("bottom", 2) = {2};
   Physical Curve("symmetry", 3) = {1};
   Physical Curve("free", 4) = {3, 4};
EndIf
Plane Surface(1) = {1};
Physical Surface("metal", 1) = {1};
Mesh 2;
Save StrCat("SSNP154_", names[body - 1], ".msh");
Exit;
