// Bolted lap joint in space, mm: two plates with two holes, heads and nuts, of hexahedra whose
// nodes match.
//
//   gmsh - bolted_lap_joint_3d.geo
//
// writes bolted_lap_joint_3d_BODY.msh for upper, lower, head_1, nut_1, head_2 and nut_2. With
// `-setnumber coarse 2` before the name of the file all elements are twice as long.
//
// The plates overlap along |x| < lap, between z = 0 and z = thick above and z = -thick below. All
// bodies are layers on one plan, which is meshed once.
DefineConstant[ coarse = 1 ];

// Holes of your own in both plates where they overlap: centres and radii. They must not touch
// the seats of the bolts, or each other. {0}, {0}, {5} is a hole between the bolts.
hole_x[] = {};
hole_y[] = {};
hole_r[] = {};

thick = 10; lap = 40; far = 90; wide = 20;
bolt_x[] = {-20, 20};     // on y = 0
bore = 6.5; seat = 11;    // radii of the holes, and of heads and nuts
high = 8;                 // of heads and nuts
size = 3 * coarse;        // of elements away from the bolts
around = 2 * Ceil(3 / coarse);                       // elements of a quarter of a circle
rings = Ceil(4 / coarse); layers = Ceil(4 / coarse); // on a seat, through a plate
high_layers = Ceil(3 / coarse);

Mesh.MshFileVersion = 2.2;
Mesh.Algorithm = 8;
Mesh.RecombineAll = 1;
Mesh.RecombinationAlgorithm = 1;
Mesh.SecondOrderIncomplete = 0;
Mesh.CharacteristicLengthFromPoints = 0;
Mesh.CharacteristicLengthMin = size;
Mesh.CharacteristicLengthMax = size;
Geometry.CopyMeshingMethod = 1;

// The plan: the lap without bolts and holes, the arms beside it, and the seats.
Point(1) = {-lap, -wide, 0}; Point(2) = {lap, -wide, 0};
Point(3) = {lap, wide, 0};   Point(4) = {-lap, wide, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
across = 2 * Ceil(wide / size);
Transfinite Curve {2, 4} = across + 1;
Transfinite Curve {1, 3} = 2 * Ceil(lap / size) + 1;
Point(5) = {far, -wide, 0}; Point(6) = {far, wide, 0};
Line(5) = {2, 5}; Line(6) = {5, 6}; Line(7) = {6, 3};
Point(7) = {-far, -wide, 0}; Point(8) = {-far, wide, 0};
Line(8) = {4, 8}; Line(9) = {8, 7}; Line(10) = {7, 1};
along = Ceil((far - lap) / size / 1.3);
Transfinite Curve {5, -7, 8, -10} = along + 1;
Transfinite Curve {6, 9} = across + 1;
Curve Loop(1) = {5, 6, 7, -2};
Curve Loop(2) = {8, 9, 10, -4};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Surface {1, 2};
arm_up = 1; arm_down = 2;

loops[] = {};
For k In {0 : 1}
   centre = newp; Point(centre) = {bolt_x[k], 0, 0};
   p = newp; c = newc;
   For i In {0 : 3}
      a = (i + 0.5) * Pi / 2;
      Point(p + i) = {bolt_x[k] + bore * Cos(a), bore * Sin(a), 0};
      Point(p + 4 + i) = {bolt_x[k] + seat * Cos(a), seat * Sin(a), 0};
      // The shank's cross-section is a square within a ring.
      Point(p + 8 + i) = {bolt_x[k] + 0.5 * bore * Cos(a), 0.5 * bore * Sin(a), 0};
   EndFor
   For i In {0 : 3}
      j = (i + 1) % 4;
      Circle(c + i) = {p + i, centre, p + j};
      Circle(c + 4 + i) = {p + 4 + i, centre, p + 4 + j};
      Line(c + 8 + i) = {p + i, p + 4 + i};
      Line(c + 12 + i) = {p + 8 + i, p + 8 + j};
      Line(c + 16 + i) = {p + 8 + i, p + i};
   EndFor
   Transfinite Curve {c : c + 7, c + 12 : c + 15} = around + 1;
   Transfinite Curve {c + 8 : c + 11} = rings + 1;
   Transfinite Curve {c + 16 : c + 19} = Ceil(2 / coarse) + 1;
   For i In {0 : 3}
      j = (i + 1) % 4;
      l = newreg; Curve Loop(l) = {c + i, c + 8 + j, -(c + 4 + i), -(c + 8 + i)};
      s = news; Plane Surface(s) = {l}; Transfinite Surface {s};
      seats[4 * k + i] = s;
      l = newreg; Curve Loop(l) = {c + 12 + i, c + 16 + j, -(c + i), -(c + 16 + i)};
      s = news; Plane Surface(s) = {l}; Transfinite Surface {s};
      shanks[5 * k + i] = s;
   EndFor
   l = newreg; Curve Loop(l) = {c + 12 : c + 15};
   s = news; Plane Surface(s) = {l}; Transfinite Surface {s};
   shanks[5 * k + 4] = s;
   l = newreg; Curve Loop(l) = {c + 4 : c + 7};
   loops[] += {l};
EndFor
For k In {0 : #hole_x[] - 1}
   p = newp; c = newc;
   Point(p) = {hole_x[k], hole_y[k], 0};
   For i In {0 : 3}
      Point(p + 1 + i) = {hole_x[k] + hole_r[k] * Cos(i * Pi / 2), hole_y[k] + hole_r[k] * Sin(i * Pi / 2), 0};
   EndFor
   For i In {0 : 3}
      Circle(c + i) = {p + 1 + i, p, p + 1 + (i + 1) % 4};
   EndFor
   Transfinite Curve {c : c + 3} = Ceil(hole_r[k] * Pi / 2 / size) + 2;
   l = newreg; Curve Loop(l) = {c : c + 3};
   loops[] += {l};
EndFor
l = newreg; Curve Loop(l) = {1 : 4};
outer = news; Plane Surface(outer) = {l, loops[]};
Recombine Surface {:};

// Layers above (sign 1) and below the plan.
For body In {0 : 1}
   sign = 1 - 2 * body;
   out[] = Extrude {0, 0, sign * thick} { Surface{outer}; Layers{layers}; Recombine; };
   plate[] = {out[1]};
   For k In {0 : 7}
      out[] = Extrude {0, 0, sign * thick} { Surface{seats[k]}; Layers{layers}; Recombine; };
      tops[8 * body + k] = out[0];
      plate[] += {out[1]};
   EndFor
   If (body == 0)
      out[] = Extrude {0, 0, thick} { Surface{arm_up}; Layers{layers}; Recombine; };
      upper[] = {plate[], out[1]};
      end_up = out[3];
   Else
      out[] = Extrude {0, 0, -thick} { Surface{arm_down}; Layers{layers}; Recombine; };
      lower[] = {plate[], out[1]};
      end_down = out[3];
   EndIf
   // Heads and nuts stand on the seats and over the bore.
   For k In {0 : 1}
      base[] = Translate {0, 0, sign * thick} { Duplicata { Surface{shanks[{5 * k : 5 * k + 4}]}; } };
      caps~{2 * k + body}[] = {};
      ends~{2 * k + body}[] = {};
      For i In {0 : 3}
         out[] = Extrude {0, 0, sign * high} { Surface{tops[8 * body + 4 * k + i]}; Layers{high_layers}; Recombine; };
         caps~{2 * k + body}[] += {out[1]};
      EndFor
      For i In {0 : 4}
         out[] = Extrude {0, 0, sign * high} { Surface{base[i]}; Layers{high_layers}; Recombine; };
         caps~{2 * k + body}[] += {out[1]};
         ends~{2 * k + body}[] += {base[i]};
      EndFor
   EndFor
EndFor
Mesh 3;

// Each body becomes a file of its own.
For body In {0 : 1}
   Physical Surface("faying", 1) = {outer, seats[]};
   Physical Surface("seat_1", 2) = {tops[{8 * body : 8 * body + 3}]};
   Physical Surface("seat_2", 3) = {tops[{8 * body + 4 : 8 * body + 7}]};
   If (body == 0)
      Physical Surface("end", 4) = {end_up};
      Physical Volume("steel", 1) = {upper[]};
      Save "bolted_lap_joint_3d_upper.msh";
   Else
      Physical Surface("end", 4) = {end_down};
      Physical Volume("steel", 1) = {lower[]};
      Save "bolted_lap_joint_3d_lower.msh";
   EndIf
   Delete Physicals;
   For k In {0 : 1}
      Physical Surface("seat", 5) = {tops[{8 * body + 4 * k : 8 * body + 4 * k + 3}]};
      Physical Surface("shank", 6) = {ends~{2 * k + body}[]};
      Physical Volume("steel", 1) = {caps~{2 * k + body}[]};
      Save Sprintf(StrChoice(body, "bolted_lap_joint_3d_nut_%g.msh", "bolted_lap_joint_3d_head_%g.msh"), k + 1);
      Delete Physicals;
   EndFor
EndFor
