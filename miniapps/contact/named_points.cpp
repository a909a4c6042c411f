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
using Eigen::Vector3d;
using Eigen::VectorXd;

NamedPoints::NamedPoints(Study &study, const JointCase &joint, Scene &scene,
                         const HalfPlane *half_plane)
   : study_(study), joint_(joint), scene_(scene), half_plane_(half_plane)
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
         const HalfPlane &plane = *half_plane_;
         const double depth = plane.normal.dot(point.at.head<2>() - plane.point);
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
         if (scene_.bodies.empty()) { continue; } // elements are not known
         const int dimension = scene_.meshes[b]->Dimension();
         mfem::DenseMatrix at(dimension, 1);
         for (int c = 0; c < dimension; ++c) { at(c, 0) = point.at[c]; }
         mfem::Array<int> element;
         mfem::Array<mfem::IntegrationPoint> within;
         scene_.meshes[b]->FindPoints(at, element, within, false);
         if (element[0] < 0) { continue; }
         place.element = element[0];
         place.within = within[0];
      }
      found = true;
      places_.push_back(place);
   }
   require(found, "key 'points.", point.name, "': (", point.at[0], ", ", point.at[1],
           joint_.in_space() ? ", " + message_text(point.at[2]) : "", ") is in no body",
           point.body >= 0 ? " of that name" : "",
           scene_.bodies.empty() ? " whose elements are known" : "", ", must be within one");
}

std::vector<NamedPoints::Value> NamedPoints::values(const ContactState &state)
{
   Reduction &reduction = scene_.reduction;
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
         const HalfPlane &plane = *half_plane_;
         const HalfPlaneField field(plane, line, forces, plane.bulk_stress(loads));
         for (std::size_t k = 0; k < places_.size(); ++k)
         {
            if (places_[k].body != body) { continue; }
            const HalfPlaneField::Point at = field.at(places_[k].at.head<2>());
            all[k] = {{at.displacement[0], at.displacement[1], 0}, {at.xx, at.yy, 0, at.xy}};
            if (plane.material.state == PlaneState::strain)
            {
               all[k].stress.zz = plane.material.poisson * (at.xx + at.yy);
            }
         }
         continue;
      }
      ElasticBody &elastic = *scene_.bodies[b];
      const VectorXd u = reduction.displacement(body, state.v, state.w, state.multipliers);
      mfem::GridFunction field(&elastic.space());
      mfem::Vector dofs(u.size());
      std::copy(u.begin(), u.end(), dofs.begin());
      field.SetFromTrueDofs(dofs);
      mfem::IsoparametricTransformation transformation;
      for (std::size_t k = 0; k < places_.size(); ++k)
      {
         if (places_[k].body != body) { continue; }
         scene_.meshes[b]->GetElementTransformation(places_[k].element, &transformation);
         transformation.SetIntPoint(&places_[k].within);
         mfem::Vector moved(elastic.components());
         field.GetVectorValue(transformation, places_[k].within, moved);
         all[k].stress = stress_at(elastic, field, transformation, loads);
         for (int c = 0; c < moved.Size(); ++c) { all[k].displacement[c] = moved[c]; }
      }
   }
   return all;
}

std::vector<double> NamedPoints::numbers(const Place &place, const Value &value) const
{
   const auto &[u, s] = value;
   if (joint_.in_space())
   {
      return {place.at[0], place.at[1], place.at[2], u[0], u[1], u[2],         s.xx,
              s.yy,        s.zz,        s.xy,        s.yz, s.xz, s.von_mises()};
   }
   return {place.at[0], place.at[1], u[0], u[1], s.xx, s.yy, s.zz, s.xy, s.von_mises()};
}

void NamedPoints::begin(const ContactState &state)
{
   if (places_.empty() || study_.csv().empty() || !writes()) { return; }
   const std::string file = study_.csv() + "_point_history.csv",
                     header = joint_.in_space()
                                 ? "time,point,body,x,y,z,ux,uy,uz,xx,yy,zz,xy,yz,xz,von_mises"
                                 : "time,point,body,x,y,ux,uy,xx,yy,zz,xy,von_mises";
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
      rows << state.time << ',' << csv_field(places_[k].name) << ','
           << csv_field(joint_.bodies[places_[k].body].name);
      for (const double value : numbers(places_[k], now[k])) { rows << ',' << value; }
      rows << '\n';
   }
   file_->add(rows.str());
}

void NamedPoints::report(const ContactState &state)
{
   if (places_.empty()) { return; }
   const bool about_axis = joint_.formulation == Formulation::axisymmetric;
   const auto word = [&](const char *plane, const char *revolved)
   { return std::string(about_axis ? revolved : plane); };
   const Units &u = study_.units;
   const std::string length = u.of(0, 1), stress = u.of(1, -2);
   std::vector<Column> columns = {{"point", "point"}, {"body", "of"}};
   const auto add =
      [&](const std::string &key, const std::string &head, bool space_alone = false)
   {
      if (!space_alone || joint_.in_space()) { columns.push_back({key, head, "%.5g"}); }
   };
   add("x", word("at x", "at r") + length);
   add("y", word("y", "z") + length);
   add("z", "z" + length, true);
   add("ux", word("moves in x", "moves in r") + length);
   add("uy", word("in y", "in z") + length);
   add("uz", "in z" + length, true);
   add("xx", word("stress xx", "stress rr") + stress);
   add("yy", word("yy", "zz") + stress);
   add("zz", word("zz", "circumferential") + stress);
   add("xy", word("xy", "rz") + stress);
   add("yz", "yz" + stress, true);
   add("xz", "xz" + stress, true);
   add("von_mises", "von Mises" + stress);
   ResultTable &table = study_.table("points", columns);
   const std::vector<Value> now = values(state);
   for (std::size_t k = 0; k < places_.size(); ++k)
   {
      const Place &place = places_[k];
      std::vector<nlohmann::ordered_json> row = {place.name, joint_.bodies[place.body].name};
      for (const double value : numbers(place, now[k])) { row.emplace_back(value); }
      study_.row(table, row);
   }
}

} // namespace miniapp
