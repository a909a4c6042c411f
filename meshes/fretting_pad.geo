// Cylindrical fretting pad, mm: a block of 10 x 8 whose lower side is an arc of radius 50, for the
// tutorial (docs/tutorial.md).
//
//   gmsh -2 fretting_pad.geo -o fretting_pad.msh
Mesh.MshFileVersion = 2.2;
Mesh.ElementOrder = 2;
Mesh.Algorithm = 6;

radius = 50; half = 5; height = 8;
near = 0.6; // the part of the arc that may touch, |x| < near
fine = 0.02;

Point(1) = {0, radius, 0}; // centre of the arc, which touches y = 0 at x = 0
Point(2) = {-half, radius - Sqrt(radius^2 - half^2), 0, 1};
Point(3) = {-near, radius - Sqrt(radius^2 - near^2), 0, fine};
Point(4) = {near, radius - Sqrt(radius^2 - near^2), 0, fine};
Point(5) = {half, radius - Sqrt(radius^2 - half^2), 0, 1};
Point(6) = {half, height, 0, 2};
Point(7) = {-half, height, 0, 2};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Line(4) = {5, 6};
Line(5) = {6, 7};
Line(6) = {7, 2};
Transfinite Curve {2} = Round(2 * near / fine) + 1;
Curve Loop(1) = {1:6};
Plane Surface(1) = {1};
Physical Curve("contact", 1) = {2};
Physical Curve("grip", 2) = {5};
Physical Curve("free", 3) = {1, 3, 4, 6};
Physical Surface("steel", 1) = {1};
