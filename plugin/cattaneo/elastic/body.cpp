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

/// InputError if an entry is not finite.
double largest_entry(const mfem::SparseMatrix &K)
{
   double largest = 0.0;
   for (int k = 0; k < K.NumNonZeroElems(); ++k)
   {
      const double entry = K.GetData()[k];
      require(std::isfinite(entry), "elastic body: entry ", k, " of the stiffness is ", entry,
              ", must be finite");
      largest = std::max(largest, std::abs(entry));
   }
   return largest;
}

void check_symmetric(double largest, double skew)
{
   require(skew <= 1e-10 * largest,
           "elastic body: the stiffness is not symmetric: largest |K - Kᵀ| is ", skew,
           ", at most ", 1e-10 * largest, " is allowed");
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
   const int attributes = mesh.attributes.Size() ? mesh.attributes.Max() : 1;
   require(static_cast<int>(materials_.size()) <= attributes, "elastic body: there are ",
           materials_.size(), " materials, the largest element attribute is ", attributes,
           ", there must be one for each from 1 to it");
   make_space(mesh, order);
   assemble();
}

ElasticBody::ElasticBody(mfem::Mesh &mesh, int order, Field young, Field poisson,
                         Formulation formulation, PlaneState state)
   : formulation_(formulation),
     varying_(VaryingMaterial{std::move(young), std::move(poisson), state})
{
   checked(mesh);
   checked_order(order);
   ranks_ = Ranks(mesh);
   require(formulation == Formulation::plane || state == PlaneState::strain,
           "elastic body: the material is in plane stress, which a body of revolution is not");
   make_space(mesh, order);
   assemble();
}

void ElasticBody::make_space(mfem::Mesh &mesh, int order)
{
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
}

void ElasticBody::check_space() const
{
   const mfem::FiniteElementSpace &space = *space_;
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
}

ElasticBody::ElasticBody(mfem::FiniteElementSpace &space, const mfem::SparseMatrix &stiffness,
                         Formulation formulation)
   : space_(&space), formulation_(formulation)
{
   checked(*space.GetMesh());
   require(Ranks(*space.GetMesh()).size() == 1,
           "elastic body: the mesh is distributed, an operator of one's own on it must be a "
           "HypreParMatrix");
   check_space();
   require(stiffness.Finalized(), "elastic body: the stiffness is not finalized");
   const int size = space.GetTrueVSize();
   require(stiffness.Height() == size && stiffness.Width() == size,
           "elastic body: the stiffness is ", stiffness.Height(), "×", stiffness.Width(),
           ", must be ", size, "×", size, " (true dofs of the space)");
   check_symmetric(largest_entry(stiffness), stiffness.IsSymmetric());
   stiffness_ = std::make_shared<mfem::SparseMatrix>(stiffness);
   adopt_space();
}

#ifdef MFEM_USE_MPI

ElasticBody::ElasticBody(mfem::ParFiniteElementSpace &space,
                         const mfem::HypreParMatrix &stiffness, Formulation formulation)
   : space_(&space), formulation_(formulation)
{
   checked(*space.GetMesh());
   ranks_ = Ranks(*space.GetMesh());
   check_space();
   const int size = space.GetTrueVSize();
   const bool fits = stiffness.Height() == size && stiffness.Width() == size;
   require(!ranks_.any(!fits), "elastic body: the stiffness on this rank is ",
           stiffness.Height(), "×", stiffness.Width(), ", must be ", size, "×", size,
           " (true dofs of the space), and so on all others");
   const auto largest = [this](const mfem::HypreParMatrix &K)
   {
      mfem::SparseMatrix own, others;
      HYPRE_BigInt *columns = nullptr;
      K.GetDiag(own);
      K.GetOffd(others, columns);
      return ranks_.max(std::max(largest_entry(own), largest_entry(others)));
   };
   const std::unique_ptr<mfem::HypreParMatrix> transposed(stiffness.Transpose());
   const std::unique_ptr<mfem::HypreParMatrix> difference(
      mfem::Add(1.0, stiffness, -1.0, *transposed));
   check_symmetric(largest(stiffness), largest(*difference));
   distributed_ = std::make_shared<mfem::HypreParMatrix>(stiffness);
   adopt_space();
}

std::shared_ptr<const mfem::HypreParMatrix> ElasticBody::distributed_stiffness() const
{
   return distributed_;
}

#endif

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
      varying_ ? assemble_stiffness(*space_, *varying_, formulation_)
               : assemble_stiffness(*space_, materials_, formulation_);
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

void ElasticBody::fix(const mfem::Array<int> &true_dofs)
{
   const int size = space_->GetTrueVSize();
   std::vector<int> times(size, 0);
   for (int dof : true_dofs)
   {
      require(dof >= 0 && dof < size, "fix: true dof ", dof, ", must be from 0 to ", size - 1);
      ++times[dof];
   }
   for (int dof : true_dofs)
   {
      require(times[dof] == 1, "fix: true dof ", dof, " is there ", times[dof],
              " times, must be there once (a boundary marker goes into fix(marker, "
              "component))");
   }
   for (int dof : true_dofs) { essential_[dof] = true; }
}

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
           " are given, must be ", size, " (true dofs of the space)");
   for (int dof = 0; dof < size; ++dof)
   {
      require(std::isfinite(forces(dof)), "forces '", pattern, "': that of true dof ", dof,
              " is ", forces(dof), ", must be finite");
   }
   load(pattern, Control::force).values += view(forces);
}

void ElasticBody::add_forces(const std::string &pattern, const mfem::LinearForm &form)
{
   require(form.FESpace() == space_, "forces '", pattern,
           "': the linear form is on a space of ", form.Size(),
           " dofs that is not the body's, must be on ElasticBody::space()");
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
                               const Field &p)
{
   check_component("pressure '" + pattern + "'", 1);
   add_boundary_load(pattern, part, "pressure",
                     [&p](BoundaryEdge &edge, double s, const std::string &where)
                     {
                        const auto d = edge.derivative(s);
                        // Left of the direction with the body on the left, of length ds.
                        const double value =
                           (edge.body_on_left() ? 1.0 : -1.0) * p.at(edge.at(s), where);
                        return std::array<double, 2>{-d[1] * value, d[0] * value};
                     });
}

void ElasticBody::add_traction(const std::string &pattern, const BoundaryPart &part,
                               const Field &tx, const Field &ty)
{
   check_component("traction '" + pattern + "'", 1);
   add_boundary_load(
      pattern, part, "traction",
      [&tx, &ty](BoundaryEdge &edge, double s, const std::string &where)
      {
         const auto d = edge.derivative(s);
         const double ds = std::hypot(d[0], d[1]);
         mfem::ElementTransformation &place = edge.at(s);
         return std::array<double, 2>{ds * tx.at(place, where), ds * ty.at(place, where)};
      });
}

void ElasticBody::add_traction(const std::string &pattern, const BoundaryPart &part,
                               const Field &t)
{
   require(formulation_ == Formulation::torsion, "traction '", pattern,
           "': one component is given, must be two unless the body is one of torsion");
   add_boundary_load(pattern, part, "traction",
                     [&t](BoundaryEdge &edge, double s, const std::string &where)
                     {
                        const auto x = edge.point(s), d = edge.derivative(s);
                        return std::array<double, 2>{std::hypot(d[0], d[1]) *
                                                        lever(Formulation::torsion, x[0]) *
                                                        t.at(edge.at(s), where),
                                                     0.0};
                     });
}

/// What the virtual displacement φ of component c meets at a point: force[c] φ + flux[c] · ∇φ.
struct ElasticBody::PointLoad
{
   double force[2], flux[2][2];
};

template <class Density>
void ElasticBody::add_volume_load(const std::string &pattern, bool at_points_of_stiffness,
                                  Density density)
{
   load(pattern, Control::force);
   mfem::Mesh &mesh = *space_->GetMesh();
   mfem::Vector forces(space_->GetVSize()), shape, x(2);
   mfem::DenseMatrix gradient;
   forces = 0.0;
   mfem::Array<int> dofs;
   mfem::IsoparametricTransformation transformation;
   for (int e = 0; e < mesh.GetNE(); ++e)
   {
      const mfem::FiniteElement &element = *space_->GetFE(e);
      shape.SetSize(element.GetDof());
      gradient.SetSize(element.GetDof(), 2);
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
            for (int c = 0; c < 2; ++c)
            {
               forces(space_->DofToVDof(dofs[a], c)) +=
                  weight * (here.force[c] * shape(a) + here.flux[c][0] * gradient(a, 0) +
                            here.flux[c][1] * gradient(a, 1));
            }
         }
      }
   }
   add_to_pattern(pattern, forces);
}

void ElasticBody::add_body_force(const std::string &pattern, const Field &bx, const Field &by)
{
   const std::string where = "body force '" + pattern + "'";
   check_component(where, 1);
   add_volume_load(pattern, false,
                   [&](mfem::ElementTransformation &place, double) -> PointLoad {
                      return {{bx.at(place, where), by.at(place, where)}, {}};
                   });
}

void ElasticBody::add_initial_strain(const std::string &pattern, const Field &strain)
{
   const std::string where = "initial strain '" + pattern + "'";
   add_strain_field(pattern,
                    [strain, where](mfem::ElementTransformation &place)
                    {
                       const double e = strain.at(place, where);
                       return Strain{e, e, e, 0};
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
      [&strain, where](mfem::ElementTransformation &place)
      {
         mfem::DenseMatrix e(3);
         strain.Eval(e, place, place.GetIntPoint());
         const bool sound = e(0, 1) == e(1, 0) && e(0, 2) == 0 && e(2, 0) == 0 &&
                            e(1, 2) == 0 && e(2, 1) == 0 && std::isfinite(e.FNorm());
         mfem::Vector x(2);
         if (!sound) { place.Transform(place.GetIntPoint(), x); }
         require(sound, where, ": the matrix at (", x(0), ", ", x(1),
                 ") must be finite, symmetric and without shear out of the plane");
         return Strain{e(0, 0), e(1, 1), e(2, 2), 2 * e(0, 1)};
      });
}

void ElasticBody::add_strain_field(const std::string &pattern, StrainField strain)
{
   require(
      has_material() && components() == 2, "initial strain '", pattern, "': the body ",
      has_material() ? "twists" : "has an operator of one's own",
      ", it must be plane or axisymmetric and have a material (add_forces takes the forces "
      "of a strain, set_stress its stresses)");
   add_volume_load(pattern, true,
                   [&](mfem::ElementTransformation &place, double r) -> PointLoad
                   {
                      const Stress s = stress(material(place), strain(place));
                      const double hoop =
                         formulation_ == Formulation::axisymmetric ? s.zz / r : 0.0;
                      return {{hoop, 0}, {{s.xx, s.xy}, {s.xy, s.yy}}};
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
      const Strain e = one.at(at);
      sum.xx += load->second * e.xx;
      sum.yy += load->second * e.yy;
      sum.zz += load->second * e.zz;
      sum.xy += load->second * e.xy;
   }
   return sum;
}

void ElasticBody::set_stress(StressLaw law)
{
   require(components() == 2,
           "set stress: the body is one of torsion, must be plane or axisymmetric");
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
   const double x = coordinates_(0, node), y = coordinates_(1, node);
   require(std::isfinite(value), where, ": the value at (", x, ", ", y, ") is ", value,
           ", must be finite");
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

void ElasticBody::add_displacement(const std::string &pattern, const BoundaryPart &part,
                                   int component, const ScalarField &u)
{
   const std::string where = "displacement '" + pattern + "'";
   check_component(where, component);
   const std::vector<int> nodes = nodes_on(part, where);
   load(pattern, Control::displacement);
   for (int node : nodes)
   {
      prescribe(pattern, node, component, u(coordinates_(0, node), coordinates_(1, node)));
   }
}

void ElasticBody::add_displacement(const std::string &pattern, const BoundaryPart &part,
                                   const mfem::GridFunction &u)
{
   const std::string where = "displacement '" + pattern + "'";
   require(u.FESpace() == space_, where, ": the grid function is on a space of ", u.Size(),
           " dofs that is not the body's, must be on ElasticBody::space()");
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
   require(!varying_, "elastic body: its material varies, ask for that of a point");
   require(attribute >= 1 && attribute <= static_cast<int>(materials_.size()),
           "elastic body: there is no material for element attribute ", attribute,
           ", there are those from 1 to ", materials_.size());
   return materials_[attribute - 1];
}

Material ElasticBody::material(mfem::ElementTransformation &at) const
{
   return varying_ ? varying_->at(at) : material(at.Attribute);
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
