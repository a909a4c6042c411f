#include <cattaneo/elastic/stress.hpp>
#include <cattaneo/halfplane/half_plane_field.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/output/paraview_half_plane.hpp>
#include <filesystem>

namespace cattaneo
{

namespace
{

using Eigen::Vector2d;

constexpr const char *names[] = {"displacement", "sigma_xx", "sigma_yy",
                                 "sigma_zz",     "tau_xy",   "von_mises"};

/// Rows of elements whose size grows from the contact on. Along it only a part of its nodes is
/// used.
mfem::Mesh window(const HalfPlane &body, const ContactLine &line)
{
   require(line.formulation == Formulation::plane,
           "ParaView output: the contact line is of a half-space, must be of a half-plane");
   const Vector2d tangent(body.normal[1], -body.normal[0]);
   std::vector<double> places;
   for (const LineNode &node : line.nodes)
   {
      places.push_back((node.position - body.point).dot(tangent));
   }
   const double from = places.front(), to = places.back(), length = to - from,
                smallest = length / 80, beyond = 1.5 * length, growth = 1.2;
   std::vector<double> x{from};
   for (double place : places)
   {
      if (place >= x.back() + smallest) { x.push_back(place); }
   }
   x.back() = to;
   const double nothing = 1e-9 * length;
   if (!body.is_symmetric() || std::abs(to) > nothing)
   {
      x = joined({x, graded(to, to + beyond, smallest, growth)});
   }
   if (!body.is_symmetric() || std::abs(from) > nothing)
   {
      std::vector<double> before = graded(from, from - beyond, smallest, growth);
      std::reverse(before.begin(), before.end());
      x = joined({before, x});
   }
   mfem::Mesh mesh = rectangle_mesh(x, graded(0, beyond, smallest, growth));
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *vertex = mesh.GetVertex(v);
      const Vector2d place = body.point + vertex[0] * tangent + vertex[1] * body.normal;
      vertex[0] = place[0];
      vertex[1] = place[1];
   }
   return mesh;
}

} // namespace

void make_folder(const std::string &folder)
{
   std::error_code error;
   std::filesystem::create_directories(folder, error);
   require(!error, "ParaView output: cannot make the folder '", folder, "': ", error.message());
}

void save(mfem::ParaViewDataCollection &series, const std::string &folder, double time)
{
   make_folder(folder);
   series.SetCycle(series.GetCycle() + 1);
   series.SetTime(time);
   series.Save();
   require(series.Error() == 0, "ParaView output: cannot write into the folder '", folder, "'");
}

HalfPlaneFields::HalfPlaneFields(const HalfPlane &body, const ContactLine &line,
                                 const std::string &directory, const std::string &name)
   : body_(body), line_(line), directory_(directory), mesh_(window(body, line)),
     displacements_(&mesh_, &nodal_, 2), stresses_(&mesh_, &broken_), series_(name, &mesh_)
{
   series_.SetPrefixPath(directory);
   for (const char *field : names)
   {
      fields_.push_back(
         std::make_unique<mfem::GridFunction>(fields_.empty() ? &displacements_ : &stresses_));
      *fields_.back() = 0.0;
      series_.RegisterField(field, fields_.back().get());
   }
}

const mfem::GridFunction &HalfPlaneFields::field(const std::string &name) const
{
   for (std::size_t k = 0; k < fields_.size(); ++k)
   {
      if (name == names[k]) { return *fields_[k]; }
   }
   throw InputError("ParaView output: there is no field '" + name + "' of a half-plane");
}

void HalfPlaneFields::write(const Eigen::VectorXd &forces, double time, const NamedLoads &loads)
{
   const HalfPlaneField inside(body_, line_, forces, body_.bulk_stress(loads));
   const Material &material = body_.material;
   mfem::Array<int> vertices, dofs, vertex_dofs;
   std::vector<HalfPlaneField::Point> points;
   for (int v = 0; v < mesh_.GetNV(); ++v)
   {
      points.push_back(inside.at({mesh_.GetVertex(v)[0], mesh_.GetVertex(v)[1]}));
      displacements_.GetVertexVDofs(v, vertex_dofs);
      for (int c : {0, 1}) { (*fields_[0])(vertex_dofs[c]) = points.back().displacement[c]; }
   }
   for (int e = 0; e < mesh_.GetNE(); ++e)
   {
      mesh_.GetElementVertices(e, vertices);
      stresses_.GetElementDofs(e, dofs);
      const int corner[] = {0, 1, 3, 2}; // of the nodes of a broken element, row by row
      for (int k = 0; k < dofs.Size(); ++k)
      {
         const HalfPlaneField::Point &at = points[vertices[corner[k]]];
         Stress s{at.xx, at.yy, 0, at.xy};
         if (material.state == PlaneState::strain) { s.zz = material.poisson * (s.xx + s.yy); }
         const double values[] = {s.xx, s.yy, s.zz, s.xy, s.von_mises()};
         for (int c = 0; c < 5; ++c) { (*fields_[c + 1])(dofs[k]) = values[c]; }
      }
   }
   save(series_, directory_, time);
}

} // namespace cattaneo
