#include "contact/sketch.hpp"

#include "common/miniapp.hpp"
#include "common/text.hpp"

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
   filled_ = elements <= most_elements;
   ordered_json bodies = ordered_json::array();
   for (std::size_t k = 0; k < scene.meshes.size(); ++k)
   {
      const mfem::Mesh &mesh = *scene.meshes[k];
      ordered_json x = ordered_json::array(), y = x, cells = x, edges = x;
      for (int v = 0; v < mesh.GetNV(); ++v)
      {
         x.push_back(rounded_to_look_at(mesh.GetVertex(v)[0]));
         y.push_back(rounded_to_look_at(mesh.GetVertex(v)[1]));
      }
      mfem::Array<int> vertices;
      for (int e = 0; filled_ && e < mesh.GetNE(); ++e)
      {
         mesh.GetElementVertices(e, vertices);
         cells.push_back(vertices_of(vertices));
      }
      for (int e = 0; e < mesh.GetNBE(); ++e)
      {
         mesh.GetBdrElementVertices(e, vertices);
         edges.push_back(vertices_of(vertices));
      }
      bodies.push_back({{"name", scene.reduction.bodies[k].name},
                        {"x", x},
                        {"y", y},
                        {"elements", cells},
                        {"edges", edges}});
   }
   study.sketch = {{"bodies", bodies}, {"frames", ordered_json::array()}};
}

void Sketch::note(const ContactState &reached)
{
   // The last state of a march may be passed again.
   if (!wanted_ || (last_ && last_->state.time == reached.time)) { return; }
   last_ = Kept{rows_, reached};
   if (rows_++ % stride_ == 0) { kept_.push_back(*last_); }
   if (kept_.size() <= most_states) { return; }
   std::vector<Kept> half;
   for (std::size_t k = 0; k < kept_.size(); k += 2) { half.push_back(std::move(kept_[k])); }
   kept_ = std::move(half);
   stride_ *= 2;
}

ordered_json Sketch::frame(const ContactState &state, std::size_t row)
{
   ordered_json u = ordered_json::array(), v = u, stresses = u;
   for (std::size_t k = 0; k < scene_.bodies.size(); ++k)
   {
      const ElasticBody &body = *scene_.bodies[k];
      const VectorXd moved = scene_.reduction.displacement(static_cast<int>(k), state.v,
                                                           state.w, state.multipliers);
      const NamedLoads loads = named(scene_.problem(), state.multipliers);
      mfem::GridFunction field(&body.space());
      mfem::Vector dofs(moved.size());
      std::copy(moved.begin(), moved.end(), dofs.begin());
      field.SetFromTrueDofs(dofs);
      mfem::Mesh &mesh = *scene_.meshes[k];
      ordered_json of_body[2] = {ordered_json::array(), ordered_json::array()},
                   of_elements = ordered_json::array();
      for (const int c : {0, 1})
      {
         mfem::Vector at_vertices;
         field.GetNodalValues(at_vertices, c + 1);
         for (const double x : at_vertices) { of_body[c].push_back(rounded_to_look_at(x)); }
      }
      mfem::IsoparametricTransformation at;
      for (int e = 0; filled_ && e < mesh.GetNE(); ++e)
      {
         mesh.GetElementTransformation(e, &at);
         at.SetIntPoint(&mfem::Geometries.GetCenter(mesh.GetElementBaseGeometry(e)));
         of_elements.push_back(
            rounded_to_look_at(stress_at(body, field, at, loads).von_mises()));
      }
      u.push_back(of_body[0]);
      v.push_back(of_body[1]);
      stresses.push_back(of_elements);
   }
   return {{"row", row}, {"u", u}, {"v", v}, {"mises", stresses}};
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
