// Bolted lap joint, mm: two plates (body = 1 upper, 2 lower), head (3) and nut (4) of a bolt whose
// shank lies out of the plane, each meshed on its own.
//
//   for k in 1 2 3 4; do gmsh -2 -setnumber body $k bolted_joint.geo; done
//
// The plates of 4 mm overlap along |x| < 15 at y = 0. Head and nut touch them along |x| < 5 and
// are pulled together by the shank, which ends in them along |x| < 2.5.
DefineConstant[ body = {1, Choices{1, 2, 3, 4}} ];
Mesh.MshFileVersion = 2.2;
Mesh.ElementOrder = 2;
Mesh.Algorithm = 6;

thick = 4; lap = 15; far = 60; head = 5; shank = 2.5; high = 5;
names[] = Str("upper", "lower", "head", "nut");

If (body <= 2)
   // The upper plate reaches to the right, the lower one is its half turn about the origin.
   s = (body == 1) ? 1 : -1;
   fine = (body == 1) ? 0.5 : 0.7; coarse = 2;
   Point(1) = {-lap * s, 0, 0, fine / 2};
   Point(2) = {lap * s, 0, 0, fine / 2};
   Point(3) = {far * s, 0, 0, coarse};
   Point(4) = {far * s, thick * s, 0, coarse};
   Point(5) = {lap * s, thick * s, 0, fine * 2};
   Point(6) = {head * s, thick * s, 0, fine / 2};
   Point(7) = {-head * s, thick * s, 0, fine / 2};
   Point(8) = {-lap * s, thick * s, 0, fine * 2};
   Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5};
   Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 1};
   Curve Loop(1) = {1:8};
   Physical Curve("faying", 1) = {1};
   Physical Curve("end", 2) = {3};
   Physical Curve("bolt", 3) = {6};
   Physical Curve("free", 4) = {2, 4, 5, 7, 8};
   Transfinite Curve {1} = Round(2 * lap / fine) + 1 Using Bump 0.3;
   Transfinite Curve {6} = Round(2 * head / fine * 1.5) + 1 Using Bump 0.3;
Else
   s = (body == 3) ? 1 : -1;
   fine = (body == 3) ? 0.4 : 0.45;
   Point(1) = {-head, thick * s, 0, fine / 2};
   Point(2) = {head, thick * s, 0, fine / 2};
   Point(3) = {head, (thick + high) * s, 0, 1};
   Point(4) = {shank, (thick + high) * s, 0, 1};
   Point(5) = {-shank, (thick + high) * s, 0, 1};
   Point(6) = {-head, (thick + high) * s, 0, 1};
   Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5};
   Line(5) = {5, 6}; Line(6) = {6, 1};
   Curve Loop(1) = {1:6};
   Physical Curve("seat", 1) = {1};
   Physical Curve("shank", 2) = {4};
   Physical Curve("free", 3) = {2, 3, 5, 6};
   Transfinite Curve {1} = Round(2 * head / fine) + 1 Using Bump 0.3;
EndIf
Plane Surface(1) = {1};
Physical Surface("steel", 1) = {1};
Mesh 2;
If (body == 4) ReverseMesh Surface{1}; EndIf
Save StrCat("bolted_joint_", names[body - 1], ".msh");
Exit;
