#include <algorithm>
#include <cattaneo/elastic/assembly.hpp>
#include <cattaneo/elastic/body.hpp>
#include <cattaneo/elastic/boundary_edge.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/element_check.hpp>
#include <cmath>
#include <type_traits>

namespace cattaneo
{

static_assert(std::is_same_v<decltype(std::declval<mfem::Vector &>().GetData()), double *>,
              "Cattaneo needs an MFEM of double precision");

namespace
{

mfem::Mesh &checked(mfem::Mesh &mesh)
{
   require(Ranks(mesh).any(mesh.GetNE() > 0), "elastic body: the mesh has no elements");
   require(Ranks(mesh).size() == 1 || !mesh.ncmesh,
           "elastic body: the mesh is distributed and nonconforming, must be conforming");
   check_elements(mesh);
   return mesh;
}

int checked_order(int order)
{
   require(order >= 1, "elastic body: element order is ", order, ", must be at least 1");
   return order;
}

double value_at(const ScalarField &field, double x, double y, const std::string &where)
{
   const double value = field(x, y);
   require(std::isfinite(value), where, ": the value at (", x, ", ", y, ") is ", value,
           ", must be finite");
   return value;
}

const char *name(Control control)
{
   return control == Control::force ? "force" : "displacement";
}

} // namespace

ElasticBody::ElasticBody(mfem::Mesh &mesh, int order, const Material &material,
                         Formulation formulation)
   : ElasticBody(mesh, order,
                 std::vector<Material>(
                    std::max(1, mesh.attributes.Size() ? mesh.attributes.Max() : 1), material),
                 formulation)
{
}

ElasticBody::ElasticBody(mfem::Mesh &mesh, int order, const std::vector<Material> &materials,
                         Formulation formulation)
   : formulation_(formulation), materials_(materials)
{
   checked(mesh);
   checked_order(order);
   ranks_ = Ranks(mesh);
   require(!materials_.empty(), "elastic body: there is no material");
   for (const Material &material : materials_)
   {
      material.validate();
      require(formulation == Formulation::plane || material.state == PlaneState::strain,
              "elastic body: a material is in plane stress, which a body of revolution is not");
   }
   for (int attribute : mesh.attributes)
   {
      require(attribute >= 1 && attribute <= static_cast<int>(materials_.size()),
              "elastic body: element attribute ", attribute, " has no material, there are ",
              materials_.size(), " (for the attributes from 1)");
   }
   owned_collection_ = std::make_unique<mfem::H1_FECollection>(order, 2);
#ifdef MFEM_USE_MPI
   if (ranks_.distributed())
   {
      owned_space_ = std::make_unique<mfem::ParFiniteElementSpace>(
         dynamic_cast<mfem::ParMesh *>(&mesh), owned_collection_.get(), components(),
         mfem::Ordering::byVDIM);
   }
   else
#endif
   {
      owned_space_ = std::make_unique<mfem::FiniteElementSpace>(
         &mesh, owned_collection_.get(), components(), mfem::Ordering::byVDIM);
   }
   space_ = owned_space_.get();
   adopt_space();
   assemble();
}

ElasticBody::ElasticBody(mfem::FiniteElementSpace &space, const mfem::SparseMatrix &stiffness,
                         Formulation formulation)
   : space_(&space), formulation_(formulation)
{
   checked(*space.GetMesh());
   require(
      Ranks(*space.GetMesh()).size() == 1,
      "elastic body: the mesh is distributed, an operator of one's own must be on one rank");
   require(space.GetVDim() == components(), "elastic body: the space has ", space.GetVDim(),
           " components, must have ", components());
   const auto *collection = dynamic_cast<const mfem::H1_FECollection *>(space.FEColl());
   require(collection != nullptr, "elastic body: the space is of the kind ",
           space.FEColl()->Name(), ", must be H1 on the Gauss-Lobatto basis");
   require(
      collection->GetBasisType() == mfem::BasisType::GaussLobatto,
      "elastic body: the basis of the space is ",
      mfem::BasisType::Name(collection->GetBasisType()),
      ", must be Gauss-Lobatto: contact forces need nodal values and positive edge weights");
   require(!space.IsVariableOrder(),
           "elastic body: the order of the space varies from element to element, must be one");
   require(stiffness.Finalized(), "elastic body: the stiffness is not finalized");
   const int size = space.GetTrueVSize();
   require(stiffness.Height() == size && stiffness.Width() == size,
           "elastic body: the stiffness is ", stiffness.Height(), "×", stiffness.Width(),
           ", must be ", size, "×", size, " (true dofs of the space)");
   double largest = 0.0;
   for (int k = 0; k < stiffness.NumNonZeroElems(); ++k)
   {
      const double entry = stiffness.GetData()[k];
      require(std::isfinite(entry), "elastic body: entry ", k, " of the stiffness is ", entry,
              ", must be finite");
      largest = std::max(largest, std::abs(entry));
   }
   const double skew = stiffness.IsSymmetric();
   require(skew <= 1e-10 * largest,
           "elastic body: the stiffness is not symmetric: largest |K - Kᵀ| is ", skew,
           ", at most ", 1e-10 * largest, " is allowed");
   stiffness_ = std::make_shared<mfem::SparseMatrix>(stiffness);
   adopt_space();
}

void ElasticBody::adopt_space()
{
   mfem::FiniteElementSpace &space = *space_;
   mfem::Mesh &mesh = *space.GetMesh();
   vdof_to_true_.assign(space.GetVSize(), -1);
#ifdef MFEM_USE_MPI
   if (ranks_.distributed())
   {
      const auto &shared = dynamic_cast<const mfem::ParFiniteElementSpace &>(space);
      first_global_dof_ = static_cast<int>(shared.GetMyTDofOffset());
      for (int v = 0; v < space.GetVSize(); ++v)
      {
         vdof_to_true_[v] = shared.GetLocalTDofNumber(v);
      }
   }
   else
#endif
      if (const mfem::SparseMatrix *restriction = space.GetConformingRestriction())
   {
      // True dofs are those nodes that hang on no others: each row has one entry.
      const int *I = restriction->GetI(), *J = restriction->GetJ();
      for (int t = 0; t < restriction->Height(); ++t) { vdof_to_true_[J[I[t]]] = t; }
   }
   else
   {
      for (int v = 0; v < space.GetVSize(); ++v) { vdof_to_true_[v] = v; }
   }
   essential_.assign(space.GetTrueVSize(), false);

   coordinates_.SetSize(2, space.GetNDofs());
   mfem::Array<int> dofs;
   mfem::DenseMatrix points;
   mfem::IsoparametricTransformation transformation;
   const bool vertices = !mesh.GetNodes() && space.GetNDofs() == mesh.GetNV();
   for (int v = 0; vertices && v < mesh.GetNV(); ++v)
   {
      for (int c = 0; c < 2; ++c) { coordinates_(c, v) = mesh.GetVertex(v)[c]; }
   }
   for (int e = 0; !vertices && e < mesh.GetNE(); ++e)
   {
      space.GetElementDofs(e, dofs);
      mesh.GetElementTransformation(e, &transformation);
      transformation.Transform(space.GetFE(e)->GetNodes(), points);
      for (int i = 0; i < dofs.Size(); ++i)
      {
         for (int c = 0; c < 2; ++c) { coordinates_(c, dofs[i]) = points(c, i); }
      }
   }
   for (int node = 0; node < space.GetNDofs(); ++node)
   {
      require(std::isfinite(coordinates_(0, node)) && std::isfinite(coordinates_(1, node)),
              "elastic body: node ", node, " of the mesh is at (", coordinates_(0, node), ", ",
              coordinates_(1, node), "), must be finite");
   }
   hold_axis();
}

void ElasticBody::hold_axis()
{
   if (formulation_ == Formulation::plane) { return; }
   // Round-off of the coordinates.
   for (int node = 0; node < space_->GetNDofs(); ++node)
   {
      axis_radius_ = std::max(axis_radius_, 1e-12 * std::abs(coordinates_(0, node)));
   }
   axis_radius_ = ranks_.max(axis_radius_);
   for (int node = 0; node < space_->GetNDofs(); ++node)
   {
      if (on_axis(node))
      {
         const int dof = true_dof(node, 0);
         // u_θ = r ψ vanishes there by itself.
         if (formulation_ == Formulation::axisymmetric && dof >= 0) { essential_[dof] = true; }
         continue;
      }
      require(coordinates_(0, node) > 0, "elastic body: node ", node,
              " of the mesh is at r = ", coordinates_(0, node), ", z = ", coordinates_(1, node),
              ", a body of revolution must have r >= 0");
   }
}

bool ElasticBody::on_axis(int scalar_dof) const
{
   return formulation_ != Formulation::plane &&
          std::abs(coordinates_(0, scalar_dof)) <= axis_radius_;
}

void ElasticBody::check_component(const std::string &where, int component) const
{
   require(component >= 0 && component < components(), where, ": component is ", component,
           ", must be ",
           formulation_ == Formulation::plane          ? "0 (x) or 1 (y)"
           : formulation_ == Formulation::axisymmetric ? "0 (r) or 1 (z)"
                                                       : "0 (twist)");
}

void ElasticBody::assemble()
{
   std::unique_ptr<mfem::SparseMatrix> local =
      assemble_stiffness(*space_, materials_, formulation_);
   ++counters_.assemblies;
#ifdef MFEM_USE_MPI
   if (ranks_.distributed())
   {
      mfem::ParBilinearForm form(dynamic_cast<mfem::ParFiniteElementSpace *>(space_));
      distributed_.reset(form.ParallelAssemble(local.get()));
      return;
   }
#endif
   if (const mfem::SparseMatrix *P = space_->GetConformingProlongation())
   {
      local.reset(mfem::RAP(*P, *local, *P));
   }
   stiffness_ = std::move(local);
}

std::vector<int> ElasticBody::nodes_on(const BoundaryPart &part, const std::string &where) const
{
   mfem::Mesh &mesh = *space_->GetMesh();
   std::vector<int> nodes;
   mfem::Array<int> dofs;
   for (int i : boundary_elements(mesh, part, where))
   {
      BoundaryEdge edge(mesh, i);
      const double slack = interval_tolerance * edge.size();
      space_->GetBdrElementDofs(i, dofs);
      for (int node : dofs)
      {
         const double coordinate = coordinates_(part.axis, node);
         if (coordinate >= part.lo - slack && coordinate <= part.hi + slack)
         {
            nodes.push_back(node);
         }
      }
   }
#ifdef MFEM_USE_MPI
   // A node at the end of the part may belong to a rank that has no boundary element there.
   if (const auto *shared = dynamic_cast<const mfem::ParFiniteElementSpace *>(space_))
   {
      mfem::Array<int> marked(space_->GetVSize());
      marked = 0;
      for (int node : nodes) { marked[space_->DofToVDof(node, 0)] = 1; }
      shared->Synchronize(marked);
      nodes.clear();
      for (int node = 0; node < space_->GetNDofs(); ++node)
      {
         if (marked[space_->DofToVDof(node, 0)]) { nodes.push_back(node); }
      }
   }
#endif
   std::sort(nodes.begin(), nodes.end());
   nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
   require(ranks_.any(!nodes.empty()), where, ": there are no nodes on the ", describe(part));
   return nodes;
}

void ElasticBody::fix(const BoundaryPart &part, int component)
{
   check_component("fix", component);
   for (int node : nodes_on(part, "fix"))
   {
      const int dof = true_dof(node, component);
      if (dof >= 0) { essential_[dof] = true; }
   }
}

void ElasticBody::fix_node(double x, double y, int component)
{
   check_component("fix node", component);
   require(std::isfinite(x) && std::isfinite(y), "fix node: the point is (", x, ", ", y,
           "), must be finite");
   int nearest = -1;
   double distance = std::numeric_limits<double>::infinity();
   for (int node = 0; node < coordinates_.Width(); ++node)
   {
      if (true_dof(node, component) < 0) { continue; }
      const double d = std::hypot(coordinates_(0, node) - x, coordinates_(1, node) - y);
      if (d < distance)
      {
         distance = d;
         nearest = node;
      }
   }
   // The first of the ranks that have a node as near.
   const std::vector<double> distances = ranks_.gather({distance});
   const auto first = std::min_element(distances.begin(), distances.end());
   if (first - distances.begin() == ranks_.rank())
   {
      essential_[true_dof(nearest, component)] = true;
   }
}

BodyLoad &ElasticBody::load(const std::string &name_, Control control)
{
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
   load(name_, Control::force).values += view(forces);
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
            const std::array<double, 2> force = density(edge, ip.x, where);
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
   require(ranks_.any(anything), where, ": there is nothing on the ", describe(part));
   add_to_pattern(pattern, forces);
}

void ElasticBody::add_pressure(const std::string &pattern, const BoundaryPart &part,
                               const ScalarField &p)
{
   check_component("pressure '" + pattern + "'", 1);
   add_boundary_load(pattern, part, "pressure",
                     [&p](BoundaryEdge &edge, double s, const std::string &where)
                     {
                        const auto x = edge.point(s), d = edge.derivative(s);
                        // Left of the direction with the body on the left, of length ds.
                        const double value =
                           (edge.body_on_left() ? 1.0 : -1.0) * value_at(p, x[0], x[1], where);
                        return std::array<double, 2>{-d[1] * value, d[0] * value};
                     });
}

void ElasticBody::add_traction(const std::string &pattern, const BoundaryPart &part,
                               const ScalarField &tx, const ScalarField &ty)
{
   check_component("traction '" + pattern + "'", 1);
   add_boundary_load(pattern, part, "traction",
                     [&tx, &ty](BoundaryEdge &edge, double s, const std::string &where)
                     {
                        const auto x = edge.point(s), d = edge.derivative(s);
                        const double ds = std::hypot(d[0], d[1]);
                        return std::array<double, 2>{ds * value_at(tx, x[0], x[1], where),
                                                     ds * value_at(ty, x[0], x[1], where)};
                     });
}

void ElasticBody::add_traction(const std::string &pattern, const BoundaryPart &part,
                               const ScalarField &t)
{
   require(formulation_ == Formulation::torsion, "traction '", pattern,
           "': one component is given, must be two unless the body is one of torsion");
   add_boundary_load(pattern, part, "traction",
                     [&t](BoundaryEdge &edge, double s, const std::string &where)
                     {
                        const auto x = edge.point(s), d = edge.derivative(s);
                        return std::array<double, 2>{std::hypot(d[0], d[1]) *
                                                        lever(Formulation::torsion, x[0]) *
                                                        value_at(t, x[0], x[1], where),
                                                     0.0};
                     });
}

void ElasticBody::add_body_force(const std::string &pattern, const ScalarField &bx,
                                 const ScalarField &by)
{
   const std::string where = "body force '" + pattern + "'";
   check_component(where, 1);
   load(pattern, Control::force);
   mfem::Mesh &mesh = *space_->GetMesh();
   mfem::Vector forces(space_->GetVSize()), shape, x(2);
   forces = 0.0;
   mfem::Array<int> dofs;
   mfem::IsoparametricTransformation transformation;
   for (int e = 0; e < mesh.GetNE(); ++e)
   {
      const mfem::FiniteElement &element = *space_->GetFE(e);
      shape.SetSize(element.GetDof());
      space_->GetElementDofs(e, dofs);
      mesh.GetElementTransformation(e, &transformation);
      const mfem::IntegrationRule &rule = mfem::IntRules.Get(
         element.GetGeomType(), 2 * element.GetOrder() + transformation.OrderW() + 2);
      for (int k = 0; k < rule.GetNPoints(); ++k)
      {
         const mfem::IntegrationPoint &ip = rule.IntPoint(k);
         transformation.SetIntPoint(&ip);
         transformation.Transform(ip, x);
         element.CalcShape(ip, shape);
         const double weight =
            ip.weight * transformation.Weight() * measure(formulation_, x(0));
         const double force[2] = {weight * value_at(bx, x(0), x(1), where),
                                  weight * value_at(by, x(0), x(1), where)};
         for (int a = 0; a < dofs.Size(); ++a)
         {
            for (int c = 0; c < 2; ++c)
            {
               forces(space_->DofToVDof(dofs[a], c)) += shape(a) * force[c];
            }
         }
      }
   }
   add_to_pattern(pattern, forces);
}

void ElasticBody::add_displacement(const std::string &pattern, const BoundaryPart &part,
                                   int component, const ScalarField &u)
{
   const std::string where = "displacement '" + pattern + "'";
   check_component(where, component);
   const std::vector<int> nodes = nodes_on(part, where);
   Eigen::VectorXd &values = load(pattern, Control::displacement).values;
   std::size_t k = 0;
   while (patterns_[k].name != pattern) { ++k; }
   for (int node : nodes)
   {
      const int dof = true_dof(node, component);
      if (dof < 0) { continue; }
      const double x = coordinates_(0, node), y = coordinates_(1, node);
      const double value = value_at(u, x, y, where);
      require(value == 0 || formulation_ != Formulation::axisymmetric || component != 0 ||
                 !on_axis(node),
              where, ": component r at (", x, ", ", y, ") is to be ", value,
              ", must be zero on the axis");
      const double other = values(dof);
      require(!prescribed_[k][dof] ||
                 std::abs(value - other) <= 1e-9 * (std::abs(value) + std::abs(other)),
              where, ": component ", component, " at (", x, ", ", y, ") is to be ", value,
              " but was already prescribed as ", other, " by the same pattern");
      values(dof) = value;
      prescribed_[k][dof] = essential_[dof] = true;
   }
}

SharedMatrix ElasticBody::shared_stiffness() const
{
   return shared(stiffness_);
}

mfem::Array<int> ElasticBody::essential_dofs() const
{
   mfem::Array<int> dofs;
   for (std::size_t t = 0; t < essential_.size(); ++t)
   {
      if (essential_[t]) { dofs.Append(static_cast<int>(t)); }
   }
   return dofs;
}

const Material &ElasticBody::material(int attribute) const
{
   require(has_material(),
           "elastic body: its operator was given as a matrix, it has no material");
   require(attribute >= 1 && attribute <= static_cast<int>(materials_.size()),
           "elastic body: there is no material for element attribute ", attribute,
           ", there are those from 1 to ", materials_.size());
   return materials_[attribute - 1];
}

int ElasticBody::true_dof(int scalar_dof, int component) const
{
   return vdof_to_true_[space_->DofToVDof(scalar_dof, component)];
}

int ElasticBody::dofs() const
{
   return static_cast<int>(ranks_.sum(static_cast<long>(space_->GetTrueVSize())));
}

int ElasticBody::global_dof(int scalar_dof, int component) const
{
#ifdef MFEM_USE_MPI
   if (ranks_.distributed())
   {
      const auto &shared = dynamic_cast<const mfem::ParFiniteElementSpace &>(*space_);
      return static_cast<int>(
         shared.GetGlobalTDofNumber(space_->DofToVDof(scalar_dof, component)));
   }
#endif
   return true_dof(scalar_dof, component);
}

} // namespace cattaneo
