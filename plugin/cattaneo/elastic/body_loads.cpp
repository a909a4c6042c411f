#include <Eigen/Geometry>
#include <cattaneo/condense/rigid_motion.hpp>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/elastic/assembly.hpp>
#include <cattaneo/elastic/body.hpp>
#include <cattaneo/elastic/boundary_edge.hpp>
#include <cattaneo/elastic/boundary_face.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

namespace
{

const char *name(Control control)
{
   return control == Control::force ? "force" : "displacement";
}

} // namespace

BodyLoad &ElasticBody::load(const std::string &name_, Control control)
{
   require(!name_.empty(), "elastic body: a load pattern has no name, must have one");
   for (BodyLoad &pattern : patterns_)
   {
      if (pattern.name != name_) { continue; }
      require(pattern.control == control, "load pattern '", name_, "': is controlled by ",
              name(pattern.control), ", cannot be controlled by ", name(control), " as well");
      return pattern;
   }
   patterns_.push_back({name_, control, Eigen::VectorXd::Zero(space_->GetTrueVSize())});
   prescribed_.emplace_back();
   if (control == Control::displacement)
   {
      prescribed_.back().resize(essential_.size(), false);
   }
   return patterns_.back();
}

void ElasticBody::add_to_pattern(const std::string &name_, const mfem::Vector &local_forces)
{
   mfem::Vector forces = local_forces;
   if (const mfem::Operator *P = space_->GetProlongationMatrix())
   {
      forces.SetSize(P->Width());
      P->MultTranspose(local_forces, forces);
   }
   add_forces(name_, forces);
}

void ElasticBody::add_forces(const std::string &pattern, const mfem::Vector &forces)
{
   const int size = space_->GetTrueVSize();
   require(forces.Size() == size, "forces '", pattern, "': ", forces.Size(),
           " values are given, must be ", size, " (true dofs of the space)");
   for (int dof = 0; dof < size; ++dof)
   {
      require(std::isfinite(forces(dof)), "forces '", pattern, "': the force on true dof ", dof,
              " is ", forces(dof), ", must be finite");
   }
   load(pattern, Control::force).values += view(forces);
}

void ElasticBody::add_forces(const std::string &pattern, const mfem::LinearForm &form)
{
   require(form.FESpace() == space_, "forces '", pattern,
           "': the linear form is on a space of ", form.Size(),
           " dofs, must be on the space of the body, ElasticBody::space()");
   // A form that has integrators and is zero was never assembled. One without integrators may
   // have been filled by hand.
   auto &parts = const_cast<mfem::LinearForm &>(form);
   const int integrators = parts.GetDLFI()->Size() + parts.GetBLFI()->Size() +
                           parts.GetFLFI()->Size() + parts.GetDLFI_Delta()->Size();
   // MFEM does not set the entries of a new form. Its memory may hold old pointers, which read
   // as numbers below the smallest normal one, so such numbers count as zero.
   const bool filled = form.Normlinf() > std::numeric_limits<double>::min();
   require(integrators == 0 || ranks_.any(filled), "forces '", pattern,
           "': the linear form has ", integrators,
           " integrators and is zero, it must have been assembled (Assemble())");
   add_to_pattern(pattern, form);
}

template <class Density>
void ElasticBody::add_boundary_load(const std::string &pattern, const BoundaryPart &part,
                                    const char *what, Density density)
{
   const std::string where = std::string(what) + " '" + pattern + "'";
   load(pattern, Control::force);
   mfem::Mesh &mesh = *space_->GetMesh();
   mfem::Vector forces(space_->GetVSize()), shape;
   forces = 0.0;
   mfem::Array<int> dofs;
   bool anything = false;
   for (int i : boundary_elements(mesh, part, where))
   {
      BoundaryEdge edge(mesh, i);
      const mfem::FiniteElement &element = *space_->GetBE(i);
      shape.SetSize(element.GetDof());
      space_->GetBdrElementDofs(i, dofs);
      const mfem::IntegrationRule &rule = edge.rule(element.GetOrder());
      for (const auto &[from, to] : edge.pieces(part))
      {
         anything = true;
         for (int k = 0; k < rule.GetNPoints(); ++k)
         {
            mfem::IntegrationPoint ip;
            ip.Set1w(from + (to - from) * rule.IntPoint(k).x, 0.0);
            const double r = edge.point(ip.x)[0];
            const double weight =
               (to - from) * rule.IntPoint(k).weight * measure(formulation_, r);
            const Eigen::Vector2d force = density(edge, ip.x, where);
            element.CalcShape(ip, shape);
            for (int a = 0; a < dofs.Size(); ++a)
            {
               for (int c = 0; c < components(); ++c)
               {
                  forces(space_->DofToVDof(dofs[a], c)) += weight * shape(a) * force[c];
               }
            }
         }
      }
   }
   require(ranks_.any(anything), where, ": no boundary elements lie on the ", describe(part));
   add_to_pattern(pattern, forces);
}

template <class Density>
void ElasticBody::add_face_load(const std::string &pattern, const BoundaryPart &part,
                                const char *what, Density density)
{
   const std::string where = std::string(what) + " '" + pattern + "'";
   load(pattern, Control::force);
   mfem::Mesh &mesh = *space_->GetMesh();
   mfem::Vector forces(space_->GetVSize()), shape;
   forces = 0.0;
   mfem::Array<int> dofs;
   bool anything = false;
   for (int i : boundary_elements(mesh, part, where))
   {
      BoundaryFace face(mesh, i);
      if (!face.within(part, where)) { continue; }
      anything = true;
      const mfem::FiniteElement &element = *space_->GetBE(i);
      shape.SetSize(element.GetDof());
      space_->GetBdrElementDofs(i, dofs);
      const mfem::IntegrationRule &rule = face.rule(element.GetOrder());
      for (int k = 0; k < rule.GetNPoints(); ++k)
      {
         const mfem::IntegrationPoint &point = rule.IntPoint(k);
         // Force per area of the reference face.
         const Eigen::Vector3d force = density(face, point, where);
         element.CalcShape(point, shape);
         for (int a = 0; a < dofs.Size(); ++a)
         {
            for (int c = 0; c < 3; ++c)
            {
               forces(space_->DofToVDof(dofs[a], c)) += point.weight * shape(a) * force[c];
            }
         }
      }
   }
   require(anything, where, ": no boundary elements lie on the ", describe(part));
   add_to_pattern(pattern, forces);
}

void ElasticBody::check_given(const std::string &where, int given) const
{
   require(components() == given, where, ": ", given, " components are given, the body is ",
           name(formulation_), ", must be ", components());
}

ElasticBody::Extent ElasticBody::extent(const BoundaryPart &part,
                                        const std::string &called) const
{
   mfem::Mesh &mesh = *space_->GetMesh();
   Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(4, 1);
   for (int i : boundary_elements(mesh, part, called))
   {
      if (formulation_ == Formulation::space)
      {
         BoundaryFace face(mesh, i);
         if (!face.within(part, called)) { continue; }
         const mfem::IntegrationRule &rule = face.rule(space_->GetBE(i)->GetOrder());
         for (int k = 0; k < rule.GetNPoints(); ++k)
         {
            const mfem::IntegrationPoint &point = rule.IntPoint(k);
            const Eigen::Vector3d x = face.place(point);
            sum +=
               point.weight * face.inward(point).norm() * Eigen::Vector4d(1, x[0], x[1], x[2]);
         }
         continue;
      }
      BoundaryEdge edge(mesh, i);
      const mfem::IntegrationRule &rule = edge.rule(space_->GetBE(i)->GetOrder());
      for (const auto &[from, to] : edge.pieces(part))
      {
         for (int k = 0; k < rule.GetNPoints(); ++k)
         {
            const double s = from + (to - from) * rule.IntPoint(k).x;
            const Eigen::Vector2d x = edge.point(s);
            sum += (to - from) * rule.IntPoint(k).weight * edge.derivative(s).norm() *
                   measure(formulation_, x[0]) * Eigen::Vector4d(1, x[0], x[1], 0);
         }
      }
   }
   ranks_.sum(sum);
   const double size = sum(0, 0);
   if (!(size > 0)) { return {}; }
   return {size, Eigen::Vector3d(sum(1, 0), sum(2, 0), sum(3, 0)) / size};
}

void ElasticBody::add_pressure(const std::string &pattern, const BoundaryPart &part,
                               const Field &p)
{
   check_component("pressure '" + pattern + "'", 1);
   if (formulation_ == Formulation::space)
   {
      add_face_load(pattern, part, "pressure",
                    [&p](BoundaryFace &face, const mfem::IntegrationPoint &point,
                         const std::string &where) -> Eigen::Vector3d
                    { return p.at(face.at(point), where) * face.inward(point); });
      return;
   }
   add_boundary_load(pattern, part, "pressure",
                     [&p](BoundaryEdge &edge, double s, const std::string &where)
                     {
                        const Eigen::Vector2d d = edge.derivative(s);
                        // With the body on the left the inward normal is the tangent turned
                        // left, and its length is that of the derivative.
                        const double value =
                           (edge.body_on_left() ? 1.0 : -1.0) * p.at(edge.at(s), where);
                        return Eigen::Vector2d(-d[1] * value, d[0] * value);
                     });
}

void ElasticBody::add_traction(const std::string &pattern, const BoundaryPart &part,
                               const Field &tx, const Field &ty)
{
   check_component("traction '" + pattern + "'", 1);
   check_given("traction '" + pattern + "'", 2);
   add_boundary_load(pattern, part, "traction",
                     [&tx, &ty](BoundaryEdge &edge, double s, const std::string &where)
                     {
                        const double ds = edge.derivative(s).norm();
                        mfem::ElementTransformation &place = edge.at(s);
                        return Eigen::Vector2d(ds * tx.at(place, where),
                                               ds * ty.at(place, where));
                     });
}

void ElasticBody::add_traction(const std::string &pattern, const BoundaryPart &part,
                               const Field &tx, const Field &ty, const Field &tz)
{
   check_given("traction '" + pattern + "'", 3);
   add_face_load(pattern, part, "traction",
                 [&](BoundaryFace &face, const mfem::IntegrationPoint &point,
                     const std::string &where) -> Eigen::Vector3d
                 {
                    const double area = face.inward(point).norm();
                    mfem::ElementTransformation &place = face.at(point);
                    return area * Eigen::Vector3d(tx.at(place, where), ty.at(place, where),
                                                  tz.at(place, where));
                 });
}

void ElasticBody::add_traction(const std::string &pattern, const BoundaryPart &part,
                               const Field &t)
{
   require(formulation_ == Formulation::torsion, "traction '", pattern,
           "': one component is given, must be two (one only for torsion)");
   add_boundary_load(pattern, part, "traction",
                     [&t](BoundaryEdge &edge, double s, const std::string &where)
                     {
                        const double ds = edge.derivative(s).norm();
                        const double arm = lever(Formulation::torsion, edge.point(s)[0]);
                        return Eigen::Vector2d(ds * arm * t.at(edge.at(s), where), 0.0);
                     });
}

/// The virtual work of the displacement φ of component c at a point: force[c] φ + flux[c] · ∇φ.
struct ElasticBody::PointLoad
{
   double force[3], flux[3][3];
};

template <class Density>
void ElasticBody::add_volume_load(const std::string &pattern, bool at_points_of_stiffness,
                                  Density density)
{
   load(pattern, Control::force);
   mfem::Mesh &mesh = *space_->GetMesh();
   const int dimension = mesh.Dimension();
   mfem::Vector forces(space_->GetVSize()), shape, x(dimension);
   mfem::DenseMatrix gradient;
   forces = 0.0;
   mfem::Array<int> dofs;
   mfem::IsoparametricTransformation transformation;
   for (int e = 0; e < mesh.GetNE(); ++e)
   {
      const mfem::FiniteElement &element = *space_->GetFE(e);
      shape.SetSize(element.GetDof());
      gradient.SetSize(element.GetDof(), dimension);
      space_->GetElementDofs(e, dofs);
      mesh.GetElementTransformation(e, &transformation);
      const mfem::IntegrationRule &rule =
         at_points_of_stiffness
            ? stiffness_rule(element, transformation, formulation_, varying_.has_value())
            : mfem::IntRules.Get(element.GetGeomType(),
                                 2 * element.GetOrder() + transformation.OrderW() + 2);
      for (int k = 0; k < rule.GetNPoints(); ++k)
      {
         const mfem::IntegrationPoint &ip = rule.IntPoint(k);
         transformation.SetIntPoint(&ip);
         transformation.Transform(ip, x);
         element.CalcShape(ip, shape);
         element.CalcPhysDShape(transformation, gradient);
         const double weight =
            ip.weight * transformation.Weight() * measure(formulation_, x(0));
         const PointLoad here = density(transformation, x(0));
         for (int a = 0; a < dofs.Size(); ++a)
         {
            for (int c = 0; c < dimension; ++c)
            {
               double work = here.force[c] * shape(a);
               for (int d = 0; d < dimension; ++d) { work += here.flux[c][d] * gradient(a, d); }
               forces(space_->DofToVDof(dofs[a], c)) += weight * work;
            }
         }
      }
   }
   add_to_pattern(pattern, forces);
}

void ElasticBody::add_body_force(const std::string &pattern, const Field &bx, const Field &by)
{
   add_body_force(pattern, std::vector<const Field *>{&bx, &by});
}

void ElasticBody::add_body_force(const std::string &pattern, const Field &bx, const Field &by,
                                 const Field &bz)
{
   add_body_force(pattern, std::vector<const Field *>{&bx, &by, &bz});
}

void ElasticBody::add_body_force(const std::string &pattern,
                                 const std::vector<const Field *> &force)
{
   const std::string where = "body force '" + pattern + "'";
   check_component(where, 1);
   check_given(where, static_cast<int>(force.size()));
   add_volume_load(pattern, false,
                   [&](mfem::ElementTransformation &place, double)
                   {
                      PointLoad here{};
                      for (std::size_t c = 0; c < force.size(); ++c)
                      {
                         here.force[c] = force[c]->at(place, where);
                      }
                      return here;
                   });
}

void ElasticBody::add_initial_strain(const std::string &pattern, const Field &strain)
{
   const std::string where = "initial strain '" + pattern + "'";
   add_strain_field(pattern,
                    [strain, where](mfem::ElementTransformation &place)
                    {
                       const double e = strain.at(place, where);
                       return Strain{e, e, e};
                    });
}

void ElasticBody::add_initial_strain(const std::string &pattern,
                                     const std::array<Field, 4> &strain)
{
   const std::string where = "initial strain '" + pattern + "'";
   require(formulation_ != Formulation::space, where,
           ": four components are given, the body is in space, must be a 3×3 matrix or one "
           "number");
   add_strain_field(pattern,
                    [strain, where](mfem::ElementTransformation &place)
                    {
                       const auto at = [&](std::size_t k)
                       { return strain[k].at(place, where); };
                       return Strain{at(0), at(1), at(3), 2 * at(2)};
                    });
}

void ElasticBody::add_initial_strain(const std::string &pattern,
                                     mfem::MatrixCoefficient &strain)
{
   const std::string where = "initial strain '" + pattern + "'";
   require(strain.GetHeight() == 3 && strain.GetWidth() == 3, where, ": the matrix is ",
           strain.GetHeight(), "×", strain.GetWidth(), ", must be 3×3");
   add_strain_field(
      pattern,
      [&strain, where, formulation = formulation_](mfem::ElementTransformation &place)
      {
         const bool space = formulation == Formulation::space;
         mfem::DenseMatrix e(3);
         strain.Eval(e, place, place.GetIntPoint());
         const bool symmetric = e(0, 1) == e(1, 0) && e(0, 2) == e(2, 0) && e(1, 2) == e(2, 1),
                    sound = symmetric && std::isfinite(e.FNorm()) &&
                            (space || (e(0, 2) == 0 && e(1, 2) == 0));
         mfem::Vector x(3);
         x = 0.0;
         if (!sound) { place.Transform(place.GetIntPoint(), x); }
         require(sound, where, ": the matrix at ",
                 place_text({x(0), x(1), space ? x(2) : 0.0}, formulation),
                 space ? " must be finite and symmetric"
                       : " must be finite, symmetric and without shear out of the plane");
         return Strain{e(0, 0), e(1, 1), e(2, 2), 2 * e(0, 1), 2 * e(1, 2), 2 * e(0, 2)};
      });
}

void ElasticBody::add_strain_field(const std::string &pattern, StrainField strain)
{
   require(
      has_material() && components() > 1, "initial strain '", pattern, "': the body ",
      has_material() ? "is of torsion" : "has a stiffness that was given as a matrix",
      ", must be plane, axisymmetric or in space and have a material (else use add_forces for "
      "the forces of a strain, and set_stress for its stresses)");
   add_volume_load(
      pattern, true,
      [&](mfem::ElementTransformation &place, double r) -> PointLoad
      {
         const Stress s = stress(material(place), strain(place));
         const double hoop = formulation_ == Formulation::axisymmetric ? s.zz / r : 0.0;
         return {{hoop, 0, 0}, {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
      });
   initial_strains_.push_back({pattern, std::move(strain)});
}

Strain ElasticBody::initial_strain(mfem::ElementTransformation &at,
                                   const NamedLoads &loads) const
{
   Strain sum;
   for (const InitialStrain &one : initial_strains_)
   {
      const auto load = loads.find(one.pattern);
      require(load != loads.end(), "stress: the multiplier of the initial strain '",
              one.pattern, "' is not given, it must be ({{\"", one.pattern, "\", 1}})");
      sum.add(load->second, one.at(at));
   }
   return sum;
}

void ElasticBody::set_stress(StressLaw law)
{
   require(components() > 1,
           "set stress: the body is one of torsion, must be plane, axisymmetric or in space");
   stress_law_ = std::move(law);
}

void ElasticBody::prescribe(const std::string &pattern, int node, int component, double value)
{
   const std::string where = "displacement '" + pattern + "'";
   Eigen::VectorXd &values = load(pattern, Control::displacement).values;
   std::size_t k = 0;
   while (patterns_[k].name != pattern) { ++k; }
   const int dof = true_dof(node, component);
   if (dof < 0) { return; }
   const std::string at = place_text(place(node), formulation_);
   require(std::isfinite(value), where, ": the value at ", at, " is ", value,
           ", must be finite");
   require(value == 0 || formulation_ != Formulation::axisymmetric || component != 0 ||
              !on_axis(node),
           where, ": component r at ", at, " is to be ", value, ", must be zero on the axis");
   const double other = values(dof);
   const char *const axes = formulation_ == Formulation::axisymmetric ? "rz" : "xyz";
   require(!prescribed_[k][dof] ||
              std::abs(value - other) <= 1e-9 * (std::abs(value) + std::abs(other)),
           where, ": at ", at, " it is ", other, " by one statement and ", value,
           " by another, along ", axes[component],
           ": its parts must agree where they meet, or one must end before");
   values(dof) = value;
   prescribed_[k][dof] = essential_[dof] = true;
}

void ElasticBody::guide(const BoundaryPart &part, const Guide &guide)
{
   require(components() > 1,
           "guide: the body is one of torsion, must be plane, axisymmetric or "
           "in space");
   const std::vector<int> nodes = nodes_on(part, "guide");
   const int dimension = components();
   Eigen::AlignedBox3d box;
   for (int node : nodes)
   {
      box.extend(place(node));
      for (int c = 0; c < dimension; ++c)
      {
         const int dof = true_dof(node, c);
         const bool held = dof >= 0 && essential_[dof] && !(c == 0 && on_axis(node));
         const Eigen::Vector3d at = place(node);
         require(!held, "guide: the node (", at[0], ", ", at[1],
                 dimension == 3 ? ", " + message_text(at[2]) : "",
                 ") is held, moved or guided already, must be moved by this guide alone");
      }
   }
   const Eigen::Vector3d middle = box.isEmpty() ? Eigen::Vector3d(0, 0, 0) : box.center();
   const std::array<double, 3> given =
      guide.centre.value_or(std::array<double, 3>{middle[0], middle[1], middle[2]});
   const Eigen::Vector3d centre(given[0], given[1], dimension == 3 ? given[2] : 0);
   const bool revolves = formulation_ == Formulation::axisymmetric;
   const auto along_axis = [&](const Guide::Along &other)
   { return other.motion == Guide::Motion::free || other.motion == Guide::Motion::held; };
   require(!revolves || (along_axis(guide.x) && along_axis(guide.rotation)),
           "guide: in axisymmetry a guided block can only move along the axis (y), x and "
           "rotation must not be given");
   std::vector<const Guide::Along *> all{&guide.x, &guide.y, &guide.rotation};
   if (dimension == 3)
   {
      const auto six = guide.in_space();
      all.assign(six.begin(), six.end());
   }
   for (std::size_t k = 0; k < all.size(); ++k)
   {
      const Guide::Along &along = *all[k];
      const bool held = along.motion == Guide::Motion::held || (revolves && k != 1);
      const bool loaded =
         along.motion == Guide::Motion::force || along.motion == Guide::Motion::displacement;
      require(!loaded || !along.load.empty(), "guide: a load has no name, must have one");
      require(std::isfinite(along.value), "guide: the value of load '", along.load, "' is ",
              along.value, ", must be finite");
      BlockMotion block{Eigen::VectorXd::Zero(space_->GetTrueVSize()), "", along.value};
      if (along.motion == Guide::Motion::displacement)
      {
         load(along.load, Control::displacement);
      }
      if (along.motion == Guide::Motion::force)
      {
         load(along.load, Control::force);
         block.load = along.load;
      }
      const bool turns = k >= static_cast<std::size_t>(dimension);
      for (int node : nodes)
      {
         const Eigen::MatrixXd motions = rigid_at(place(node), centre, dimension);
         for (int c = 0; c < dimension; ++c)
         {
            const int dof = true_dof(node, c);
            if (dof < 0 || held || (!turns && c != static_cast<int>(k))) { continue; }
            const double motion = motions(c, static_cast<Eigen::Index>(k));
            if (along.motion == Guide::Motion::displacement)
            {
               prescribe(along.load, node, c, along.value * motion);
            }
            else { block.motion[dof] = motion; }
         }
      }
      if (!held && along.motion != Guide::Motion::displacement)
      {
         blocks_.push_back(std::move(block));
      }
   }
   for (int node : nodes)
   {
      for (int c = 0; c < dimension; ++c)
      {
         const int dof = true_dof(node, c);
         if (dof >= 0) { essential_[dof] = true; }
      }
   }
}

void ElasticBody::add_displacement(const std::string &pattern, const BoundaryPart &part,
                                   int component, const ScalarField &u)
{
   const std::string where = "displacement '" + pattern + "'";
   check_component(where, component);
   const std::vector<int> nodes = nodes_on(part, where);
   require(ranks_.any(!nodes.empty()), where, ": the ", describe(part),
           " lies on the axis, where the displacement around the axis is always zero");
   load(pattern, Control::displacement);
   for (int node : nodes)
   {
      const Eigen::Vector3d x = place(node);
      prescribe(pattern, node, component, u(x[0], x[1], x[2]));
   }
}

void ElasticBody::add_displacement(const std::string &pattern, const BoundaryPart &part,
                                   const mfem::GridFunction &u)
{
   const std::string where = "displacement '" + pattern + "'";
   require(u.FESpace() == space_, where, ": the grid function is on a space of ", u.Size(),
           " dofs, must be on the space of the body, ElasticBody::space()");
   const std::vector<int> nodes = nodes_on(part, where);
   load(pattern, Control::displacement);
   for (int node : nodes)
   {
      for (int c = 0; c < components(); ++c)
      {
         prescribe(pattern, node, c, u(space_->DofToVDof(node, c)));
      }
   }
}

} // namespace cattaneo
