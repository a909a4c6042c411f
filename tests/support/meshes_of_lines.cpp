#include "meshes_of_lines.hpp"

#include "elastic_support.hpp"

#include <algorithm>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>
#include <random>

namespace cattaneo_test
{

using namespace cattaneo;
using support::uniform;

mfem::Mesh scrambled(const mfem::Mesh &plain, int seed)
{
   std::mt19937 random(seed);
   std::vector<int> vertex(plain.GetNV()), where(plain.GetNV()), element(plain.GetNE()),
      boundary(plain.GetNBE());
   for (auto *order : {&vertex, &element, &boundary})
   {
      for (std::size_t i = 0; i < order->size(); ++i) { (*order)[i] = static_cast<int>(i); }
      std::shuffle(order->begin(), order->end(), random);
   }
   for (std::size_t i = 0; i < vertex.size(); ++i) { where[vertex[i]] = static_cast<int>(i); }
   mfem::Mesh mesh(2, plain.GetNV(), plain.GetNE(), plain.GetNBE());
   for (int v : vertex) { mesh.AddVertex(plain.GetVertex(v)); }
   for (int e : element)
   {
      const int *v = plain.GetElement(e)->GetVertices();
      const int turn = static_cast<int>(random() % 4);
      mesh.AddQuad(where[v[turn]], where[v[(turn + 1) % 4]], where[v[(turn + 2) % 4]],
                   where[v[(turn + 3) % 4]]);
   }
   for (int b : boundary)
   {
      const int *v = plain.GetBdrElement(b)->GetVertices();
      const int flip = static_cast<int>(random() % 2);
      mesh.AddBdrSegment(where[v[flip]], where[v[1 - flip]], plain.GetBdrAttribute(b));
   }
   // Topology without letting the library put the boundary in order.
   mesh.FinalizeTopology(false);
   mesh.Finalize(false, false); // turns boundary elements nevertheless
   for (int b = 0; b < mesh.GetNBE(); ++b)
   {
      int *v = mesh.GetBdrElement(b)->GetVertices();
      if (random() % 2) { std::swap(v[0], v[1]); }
   }
   return mesh;
}

mfem::Mesh ring_sector(int order, int elements, double from, double to)
{
   mfem::Mesh mesh = rectangle_mesh(uniform(0, 1, elements), uniform(0, 1, 2));
   mesh.SetCurvature(order);
   mesh.Transform(
      [=](const mfem::Vector &in, mfem::Vector &out)
      {
         const double angle = from + in(0) * (to - from), radius = 1 + in(1);
         out.SetSize(2);
         out(0) = radius * std::cos(angle);
         out(1) = radius * std::sin(angle);
      });
   return mesh;
}

} // namespace cattaneo_test
