#include "contact/sketch.hpp"

#include "common/miniapp.hpp"
#include "common/text.hpp"

#include <array>
#include <cattaneo/elastic/point_stress.hpp>
#include <cmath>
#include <cstdlib>

namespace miniapp
{

using namespace cattaneo;
using Eigen::VectorXd;
using nlohmann::ordered_json;

namespace
{

/// Largest number of states that are recovered, and of elements that are filled.
constexpr std::size_t most_states = 24;
constexpr int most_elements = 5000;

/// Five digits are enough for a picture.
double rounded_to_look_at(double x)
{
   return std::strtod(text("%.5g", x).c_str(), nullptr);
}

ordered_json vertices_of(const mfem::Array<int> &vertices)
{
   ordered_json list = ordered_json::array();
   for (const int vertex : vertices) { list.push_back(vertex); }
   return list;
}

} // namespace

Sketch::Sketch(Study &study, Scene &scene) : study_(study), scene_(scene)
{
   wanted_ = study.has_page() && ranks() == 1 && !scene.bodies.empty();
   if (!wanted_) { return; }
   int elements = 0;
   for (const auto &mesh : scene.meshes) { elements += mesh->GetNE(); }
   filled_ = elements <= most_elements || scene.meshes[0]->Dimension() == 3;
   ordered_json bodies = ordered_json::array();
   for (std::size_t k = 0; k < scene.meshes.size(); ++k) { bodies.push_back(body(k)); }
   ordered_json not_drawn = ordered_json::array(); // bodies without a mesh
   for (std::size_t k = scene.meshes.size(); k < scene.reduction.bodies.size(); ++k)
   {
      not_drawn.push_back(scene.reduction.bodies[k].name);
   }
   study.sketch = {
      {"bodies", bodies}, {"not_drawn", not_drawn}, {"frames", ordered_json::array()}};
}

/// What does not change with the increments.
ordered_json Sketch::body(std::size_t k)
{
   mfem::Mesh &mesh = *scene_.meshes[k];
   const bool in_space = mesh.Dimension() == 3;
   Drawn drawn;
   ordered_json cells = ordered_json::array(), edges = cells;
   mfem::Array<int> vertices;
   std::vector<int> number(mesh.GetNV(), in_space ? -1 : 0); // of a vertex among the drawn ones
   for (int v = 0; v < mesh.GetNV() && !in_space; ++v)
   {
      number[v] = v;
      drawn.vertices.push_back(v);
   }
   const auto add_cell = [&](int element)
   {
      ordered_json cell = ordered_json::array();
      for (const int v : vertices)
      {
         if (number[v] < 0)
         {
            number[v] = static_cast<int>(drawn.vertices.size());
            drawn.vertices.push_back(v);
         }
         cell.push_back(number[v]);
      }
      cells.push_back(cell);
      drawn.elements.push_back(element);
   };
   for (int f = 0; in_space && f < mesh.GetNumFaces(); ++f)
   {
      int element = -1, other = -1;
      mesh.GetFaceElements(f, &element, &other);
      if (other >= 0) { continue; } // within the body
      mesh.GetFaceVertices(f, vertices);
      add_cell(element);
   }
   for (int e = 0; !in_space && filled_ && e < mesh.GetNE(); ++e)
   {
      mesh.GetElementVertices(e, vertices);
      add_cell(e);
   }
   for (int e = 0; !in_space && e < mesh.GetNBE(); ++e)
   {
      mesh.GetBdrElementVertices(e, vertices);
      edges.push_back(vertices_of(vertices));
   }
   ordered_json made = {{"name", scene_.reduction.bodies[k].name}};
   const std::array<const char *, 3> axes = {"x", "y", "z"};
   for (int c = 0; c < mesh.Dimension(); ++c)
   {
      ordered_json places = ordered_json::array();
      for (const int v : drawn.vertices)
      {
         places.push_back(rounded_to_look_at(mesh.GetVertex(v)[c]));
      }
      made[axes[c]] = places;
   }
   made["elements"] = cells;
   made["edges"] = edges;
   drawn_.push_back(std::move(drawn));
   return made;
}

void Sketch::note(const ContactState &reached)
{
   // The last state of a march may be passed again.
   if (!wanted_ || (last_ && last_->state.time == reached.time)) { return; }
   last_ = Kept{rows_, reached};
   if (rows_++ % stride_ == 0) { kept_.push_back(*last_); }
   // A state in space has more numbers.
   const bool in_space = scene_.meshes[0]->Dimension() == 3;
   if (kept_.size() <= (in_space ? most_states / 2 : most_states)) { return; }
   std::vector<Kept> half;
   for (std::size_t k = 0; k < kept_.size(); k += 2) { half.push_back(std::move(kept_[k])); }
   kept_ = std::move(half);
   stride_ *= 2;
}

ordered_json Sketch::frame(const ContactState &state, std::size_t row)
{
   // Components of the displacements, u, v and in space w.
   std::array<ordered_json, 3> moved;
   moved.fill(ordered_json::array());
   ordered_json stresses = ordered_json::array();
   const NamedLoads loads = named(scene_.problem(), state.multipliers);
   const int dimension = scene_.meshes[0]->Dimension();
   for (std::size_t k = 0; k < scene_.bodies.size(); ++k)
   {
      const ElasticBody &body = *scene_.bodies[k];
      const VectorXd u = scene_.reduction.displacement(static_cast<int>(k), state.v, state.w,
                                                       state.multipliers);
      mfem::GridFunction field(&body.space());
      mfem::Vector dofs(u.size());
      std::copy(u.begin(), u.end(), dofs.begin());
      field.SetFromTrueDofs(dofs);
      mfem::Mesh &mesh = *scene_.meshes[k];
      for (int c = 0; c < dimension; ++c)
      {
         mfem::Vector at_vertices;
         field.GetNodalValues(at_vertices, c + 1);
         ordered_json of_body = ordered_json::array();
         for (const int v : drawn_[k].vertices)
         {
            of_body.push_back(rounded_to_look_at(at_vertices[v]));
         }
         moved[c].push_back(of_body);
      }
      ordered_json of_elements = ordered_json::array();
      mfem::IsoparametricTransformation at;
      for (const int e : drawn_[k].elements)
      {
         mesh.GetElementTransformation(e, &at);
         at.SetIntPoint(&mfem::Geometries.GetCenter(mesh.GetElementBaseGeometry(e)));
         of_elements.push_back(
            rounded_to_look_at(stress_at(body, field, at, loads).von_mises()));
      }
      stresses.push_back(of_elements);
   }
   ordered_json made = {{"row", row}, {"u", moved[0]}, {"v", moved[1]}, {"mises", stresses}};
   if (dimension == 3) { made["w"] = moved[2]; }
   return made;
}

void Sketch::report()
{
   if (!wanted_ || !last_) { return; }
   if (kept_.back().row != last_->row) { kept_.push_back(*last_); }
   Counters &spent = scene_.reduction.counters;
   study_.counters -= spent; // its cost is added
   for (const Kept &one : kept_)
   {
      study_.sketch["frames"].push_back(frame(one.state, one.row));
   }
   study_.counters += spent;
}

} // namespace miniapp
