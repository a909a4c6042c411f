// Dovetail of a blade: half of the root (body = 1) or of the disc segment (body = 2), mm.
//
//   gmsh -2 -setnumber body 1 dovetail.geo -o dovetail_root.msh
//   gmsh -2 -setnumber body 2 dovetail.geo -o dovetail_disc.msh
//
// The y axis points away from the disc's axis; x = 0 is the plane of symmetry. The flank of 5 mm
// is inclined by 45 degrees. Both bodies turn away from it on arcs that are tangent to it, of which
// the first 0.2 mm belong to the contact as well. The contact nodes of both bodies are placed by
// the same Transfinite rules, so that they face each other.
DefineConstant[ body = {1, Choices{1, 2}} ];
Mesh.MshFileVersion = 2.2;
Mesh.ElementOrder = 2;
Mesh.Algorithm = 6;

h = Sqrt(0.5);         // of a unit vector along the flank
flank = 5;
near = 0.2;            // contact on the arcs, measured along the flank
coarse = 1.6; fine = 0.28;

// Flank from A (below, outside) to B (above, inside).
ax = 7 + h;  ay = -3 - h;
bx = ax - flank * h;  by = ay + flank * h;

If (body == 1)
   ra = 1; rb = 2;     // lobe, convex; neck, concave
Else
   ra = 2; rb = 1;     // slot, concave; lug, convex
EndIf
// Centres of the arcs at A and at B, on the normals of the flank's ends.
cax = ax - ra * h;  cay = ay - ra * h;
cbx = bx + rb * h;  cby = by + rb * h;
ta = Asin(near / ra);  tb = Asin(near / rb);

Point(1) = {ax, ay, 0, fine};
Point(2) = {bx, by, 0, fine};
Point(3) = {cax, cay, 0, fine};
Point(4) = {cbx, cby, 0, fine};
Point(5) = {cax + ra * Cos(Pi/4 - ta), cay + ra * Sin(Pi/4 - ta), 0, fine};  // end of contact
Point(6) = {cax + ra, cay, 0, fine};                                         // arc turns vertical
Point(7) = {cbx + rb * Cos(5*Pi/4 - tb), cby + rb * Sin(5*Pi/4 - tb), 0, fine};
Point(8) = {cbx - rb, cby, 0, fine};

Line(1) = {1, 2};
Circle(2) = {5, 3, 1};
Circle(3) = {6, 3, 5};
Circle(4) = {2, 4, 7};
Circle(5) = {7, 4, 8};
Transfinite Curve {1} = 33 Using Bump 0.25;
Transfinite Curve {2, 4} = 5;

If (body == 1)
   Point(10) = {0, -8, 0, coarse};
   Point(11) = {cax + ra - 2, -8, 0, coarse};
   Point(12) = {cax + ra - 2, -6, 0, coarse};
   Point(13) = {cax + ra, -6, 0, 0.8};
   Point(14) = {cbx - rb, 10, 0, coarse};
   Point(15) = {0, 10, 0, coarse};
   Line(10) = {10, 11};
   Circle(11) = {11, 12, 13};
   Line(12) = {13, 6};
   Line(13) = {8, 14};
   Line(14) = {14, 15};
   Line(15) = {15, 10};
   Curve Loop(1) = {10, 11, 12, 3, 2, 1, 4, 5, 13, 14, 15};
   Plane Surface(1) = {1};
   Physical Surface(1) = {1};
   Physical Curve(1) = {15};              // plane of symmetry
   Physical Curve(2) = {14};              // end of the neck
   Physical Curve(3) = {2, 1, 4};         // contact
   Physical Curve(4) = {10, 11, 12, 3, 5, 13};
Else
   Point(10) = {0, -9, 0, coarse};
   Point(11) = {cax + ra - 2, -9, 0, 0.9};
   Point(12) = {cax + ra - 2, -7, 0, 0.9};
   Point(13) = {cax + ra, -7, 0, 0.8};
   Point(14) = {cbx - rb, 3, 0, 0.7};
   Point(15) = {16, 3, 0, coarse};
   Point(16) = {16, -24, 0, 2};
   Point(17) = {0, -24, 0, 2};
   Line(10) = {10, 11};
   Circle(11) = {11, 12, 13};
   Line(12) = {13, 6};
   Line(13) = {8, 14};
   Line(14) = {14, 15};
   Line(15) = {15, 16};
   Line(16) = {16, 17};
   Line(17) = {17, 10};
   Curve Loop(1) = {10, 11, 12, 3, 2, 1, 4, 5, 13, 14, 15, 16, 17};
   Plane Surface(1) = {-1};
   Physical Surface(1) = {1};
   Physical Curve(1) = {17};              // plane of symmetry
   Physical Curve(2) = {16};              // towards the axis of the disc
   Physical Curve(3) = {2, 1, 4};         // contact
   Physical Curve(4) = {10, 11, 12, 3, 5, 13, 14};
   Physical Curve(5) = {15};              // plane of symmetry between two slots
EndIf
