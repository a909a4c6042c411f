#include "contact/named_points.hpp"

#include <algorithm>
#include <cattaneo/elastic/point_stress.hpp>
#include <cattaneo/halfplane/half_plane_field.hpp>
#include <cattaneo/input_error.hpp>
#include <sstream>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Vector2d;
using Eigen::VectorXd;

NamedPoints::NamedPoints(Study &study, const JointCase &joint, OwnBodies &own)
   : study_(study), joint_(joint), own_(own)
{
   for (const JointCase::Point &point : joint.points) { find(point); }
}

void NamedPoints::find(const JointCase::Point &point)
{
   bool found = false;
   for (std::size_t b = 0; b < joint_.bodies.size(); ++b)
   {
      const auto body = static_cast<int>(b);
      if (point.body >= 0 && point.body != body) { continue; }
      Place place{point.name, body, point.at, 0, {}};
      if (joint_.bodies[b].half_plane)
      {
         const HalfPlane &plane = *own_.half_plane;
         const double depth = plane.normal.dot(point.at - plane.point);
         // A point that is on the surface within round-off counts as on it.
         if (depth < -1e-9 * point.at.norm()) { continue; }
         require(joint_.formulation == Formulation::plane &&
                    !std::isnan(joint_.bodies[b].depth),
                 "point '", point.name, "' is in the half-plane ", joint_.bodies[b].name,
                 ", whose displacements are relative to a depth: ",
                 joint_.bodies[b].source.called("half-plane.depth"),
                 " must state it (in the plane)");
      }
      else
      {
         if (own_.scene.bodies.empty()) { continue; } // elements are not known
         mfem::DenseMatrix at(2, 1);
         at(0, 0) = point.at[0];
         at(1, 0) = point.at[1];
         mfem::Array<int> element;
         mfem::Array<mfem::IntegrationPoint> within;
         own_.scene.meshes[b]->FindPoints(at, element, within, false);
         if (element[0] < 0) { continue; }
         place.element = element[0];
         place.within = within[0];
      }
      found = true;
      places_.push_back(place);
   }
   require(found, "key 'points.", point.name, "': (", point.at[0], ", ", point.at[1],
           ") is in no body", point.body >= 0 ? " of that name" : "",
           own_.scene.bodies.empty() ? " whose elements are known" : "",
           ", must be within one");
}

std::vector<NamedPoints::Value> NamedPoints::values(const ContactState &state)
{
   Reduction &reduction = own_.scene.reduction;
   const NamedLoads loads = named(reduction.problem, state.multipliers);
   std::vector<Value> all(places_.size());
   for (std::size_t b = 0; b < joint_.bodies.size(); ++b)
   {
      const auto body = static_cast<int>(b);
      if (std::none_of(places_.begin(), places_.end(),
                       [&](const Place &place) { return place.body == body; }))
      {
         continue;
      }
      if (joint_.bodies[b].half_plane)
      {
         const ContactLine &line = reduction.bodies[b].line;
         const Eigen::MatrixX2d on = reduction.contact_forces(
            body, state.q, state.p, reduction.tied_forces(state.v, state.w, state.multipliers));
         VectorXd forces(2 * line.size());
         for (Eigen::Index i = 0; i < line.size(); ++i)
         {
            forces[i] = on.row(i).dot(line.nodes[i].tangent);
            forces[line.size() + i] = on.row(i).dot(line.nodes[i].normal());
         }
         const HalfPlane &plane = *own_.half_plane;
         const HalfPlaneField field(plane, line, forces, plane.bulk_stress(loads));
         for (std::size_t k = 0; k < places_.size(); ++k)
         {
            if (places_[k].body != body) { continue; }
            const HalfPlaneField::Point at = field.at(places_[k].at);
            all[k] = {at.displacement, {at.xx, at.yy, 0, at.xy}};
            if (plane.material.state == PlaneState::strain)
            {
               all[k].stress.zz = plane.material.poisson * (at.xx + at.yy);
            }
         }
         continue;
      }
      ElasticBody &elastic = *own_.scene.bodies[b];
      const VectorXd u = reduction.displacement(body, state.v, state.w, state.multipliers);
      mfem::GridFunction field(&elastic.space());
      mfem::Vector dofs(u.size());
      std::copy(u.begin(), u.end(), dofs.begin());
      field.SetFromTrueDofs(dofs);
      mfem::IsoparametricTransformation transformation;
      for (std::size_t k = 0; k < places_.size(); ++k)
      {
         if (places_[k].body != body) { continue; }
         own_.scene.meshes[b]->GetElementTransformation(places_[k].element, &transformation);
         transformation.SetIntPoint(&places_[k].within);
         mfem::Vector moved(2);
         field.GetVectorValue(transformation, places_[k].within, moved);
         all[k] = {{moved[0], moved[1]}, stress_at(elastic, field, transformation, loads)};
      }
   }
   return all;
}

void NamedPoints::begin(const ContactState &state)
{
   if (places_.empty() || study_.csv().empty() || !writes()) { return; }
   const std::string file = study_.csv() + "_point_history.csv",
                     header = "time,point,body,x,y,ux,uy,xx,yy,zz,xy,von_mises";
   study_.begins(file, state.time > 0);
   if (state.time > 0) { file_.emplace(file, header, state.time); }
   else { file_.emplace(file, header); }
}

void NamedPoints::note(const ContactState &state)
{
   if (!file_ || state.time == last_) { return; }
   last_ = state.time;
   std::ostringstream rows;
   rows.precision(17);
   const std::vector<Value> now = values(state);
   for (std::size_t k = 0; k < places_.size(); ++k)
   {
      const auto &[displacement, s] = now[k];
      rows << state.time << ',' << csv_field(places_[k].name) << ','
           << csv_field(joint_.bodies[places_[k].body].name) << ',' << places_[k].at[0] << ','
           << places_[k].at[1];
      for (const double value :
           {displacement[0], displacement[1], s.xx, s.yy, s.zz, s.xy, s.von_mises()})
      {
         rows << ',' << value;
      }
      rows << '\n';
   }
   file_->add(rows.str());
}

void NamedPoints::report(const ContactState &state)
{
   if (places_.empty()) { return; }
   const bool plane = joint_.formulation == Formulation::plane;
   const Units &u = study_.units;
   ResultTable &table = study_.table(
      "points", {{"point", "point"},
                 {"body", "of"},
                 {"x", std::string(plane ? "at x" : "at r") + u.of(0, 1), "%.5g"},
                 {"y", std::string(plane ? "y" : "z") + u.of(0, 1), "%.5g"},
                 {"ux", std::string(plane ? "moves in x" : "moves in r") + u.of(0, 1), "%.5g"},
                 {"uy", std::string(plane ? "in y" : "in z") + u.of(0, 1), "%.5g"},
                 {"xx", std::string(plane ? "stress xx" : "stress rr") + u.of(1, -2), "%.5g"},
                 {"yy", std::string(plane ? "yy" : "zz") + u.of(1, -2), "%.5g"},
                 {"zz", std::string(plane ? "zz" : "circumferential") + u.of(1, -2), "%.5g"},
                 {"xy", std::string(plane ? "xy" : "rz") + u.of(1, -2), "%.5g"},
                 {"von_mises", "von Mises" + u.of(1, -2), "%.5g"}});
   const std::vector<Value> now = values(state);
   for (std::size_t k = 0; k < places_.size(); ++k)
   {
      const Place &place = places_[k];
      const auto &[moved, s] = now[k];
      study_.row(table, {place.name, joint_.bodies[place.body].name, place.at[0], place.at[1],
                         moved[0], moved[1], s.xx, s.yy, s.zz, s.xy, s.von_mises()});
   }
}

} // namespace miniapp
