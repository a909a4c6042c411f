// Flat punch with rounded edges (body = 1) on a block (body = 2), mm.
//
//   gmsh -2 -setnumber body 1 rounded_punch.geo -o rounded_punch.msh
//   gmsh -2 -setnumber body 2 rounded_punch.geo -o rounded_punch_block.msh
//
// The punch touches the block along |x| < 3 at y = 0 and turns away on arcs of radius 5, of which
// the part |x| < 3.2 belongs to the contact as well. The contact nodes of both bodies are placed
// by the same Transfinite rules, so that they face each other, symmetric about x = 0.
DefineConstant[ body = {1, Choices{1, 2}} ];
Mesh.MshFileVersion = 2.2;
Mesh.ElementOrder = 2;
Mesh.Algorithm = 5; // Delaunay: elements grow evenly away from the fine edges

a = 3; near = 0.2; radius = 5; half = 6; height = 10;
width = 20; depth = 20;
parts = 32; fine = near / parts; // of an arc: under 600 N/mm the contact ends 0.06 beyond the flat

// Contact: flat from 1 to 2 and from 1 to 12, arcs (or what faces them) 2 to 4 and 12 to 14.
Point(1) = {0, 0, 0, 0.3};
Point(2) = {a, 0, 0, fine};
Point(12) = {-a, 0, 0, fine};
If (body == 1)
   t = Asin(near / radius); s = Asin((half - a) / radius);
   Point(3) = {a, radius, 0};
   Point(13) = {-a, radius, 0};
   Point(4) = {a + radius * Sin(t), radius * (1 - Cos(t)), 0, fine};
   Point(14) = {-a - radius * Sin(t), radius * (1 - Cos(t)), 0, fine};
   Point(5) = {half, radius * (1 - Cos(s)), 0, 0.8};
   Point(15) = {-half, radius * (1 - Cos(s)), 0, 0.8};
   Point(6) = {half, height, 0, 2};
   Point(16) = {-half, height, 0, 2};
   Circle(2) = {2, 3, 4};
   Circle(12) = {12, 13, 14};
   Circle(3) = {4, 3, 5};
   Circle(13) = {14, 13, 15};
Else
   Point(4) = {a + near, 0, 0, fine};
   Point(14) = {-a - near, 0, 0, fine};
   Point(5) = {width, 0, 0, 2};
   Point(15) = {-width, 0, 0, 2};
   Point(6) = {width, -depth, 0, 3};
   Point(16) = {-width, -depth, 0, 3};
   Line(2) = {2, 4};
   Line(12) = {12, 14};
   Line(3) = {4, 5};
   Line(13) = {14, 15};
EndIf
Line(1) = {1, 2};
Line(11) = {1, 12};
Line(4) = {5, 6};
Line(14) = {15, 16};
Line(5) = {6, 16};
Transfinite Curve {1, 11} = 33 Using Progression 1 / 1.16;
Transfinite Curve {2, 12} = parts + 1;

Curve Loop(1) = {1, 2, 3, 4, 5, -14, -13, -12, -11};
If (body == 1)
   Plane Surface(1) = {1};
   Physical Curve(2) = {5};               // top
   Physical Curve(4) = {3, 13, 4, 14};    // rest of the arcs, sides
Else
   Plane Surface(1) = {-1};
   Physical Curve(1) = {5};               // bottom
   Physical Curve(2) = {4, 14};           // ends
   Physical Curve(4) = {3, 13};           // surface beside the punch
EndIf
Physical Surface(1) = {1};
Physical Curve(3) = {1, 2, 11, 12};       // contact
