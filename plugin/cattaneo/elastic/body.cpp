#include <algorithm>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/elastic/assembly.hpp>
#include <cattaneo/elastic/body.hpp>
#include <cattaneo/elastic/boundary_edge.hpp>
#include <cattaneo/elastic/boundary_face.hpp>
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

void check_mesh(mfem::Mesh &mesh)
{
   require(Ranks(mesh).any(mesh.GetNE() > 0), "elastic body: the mesh has no elements");
   require(Ranks(mesh).size() == 1 || !mesh.ncmesh,
           "elastic body: the mesh is distributed and nonconforming, must be conforming");
   require(mesh.Dimension() != 3 || Ranks(mesh).size() == 1,
           "elastic body: the mesh is in space and distributed, in space a body must be on one "
           "rank");
   require(mesh.Dimension() != 3 || !mesh.Nonconforming(),
           "elastic body: the mesh is in space and nonconforming, must be conforming");
   check_elements(mesh);
}

/// A mesh in space makes a body in space. InputError if the formulation is of another
/// dimension.
Formulation of_mesh(const mfem::Mesh &mesh, Formulation asked)
{
   const bool space = mesh.Dimension() == 3;
   require(space || asked != Formulation::space,
           "elastic body: the formulation is in space, the mesh is of dimension ",
           mesh.Dimension(), ", must be 3");
   require(!space || !about_axis(asked), "elastic body: the formulation is ", name(asked),
           ", the mesh is in space: it must be of the plane (r, z)");
   return space ? Formulation::space : asked;
}

/// InputError for plane stress where there is no plane.
void check_state(PlaneState state, Formulation formulation)
{
   require(formulation == Formulation::plane || state == PlaneState::strain,
           "elastic body: a material is in plane stress, which is not possible for a body ",
           formulation == Formulation::space ? "in space" : "of revolution");
}

/// Largest element attribute of the mesh, 1 if it has no elements (on this rank).
int largest_attribute(const mfem::Mesh &mesh)
{
   return std::max(1, mesh.attributes.Size() ? mesh.attributes.Max() : 1);
}

/// Largest absolute value of an entry. InputError if an entry is not finite.
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

} // namespace

ElasticBody::ElasticBody(mfem::Mesh &mesh, int order, const Material &material,
                         Formulation formulation)
   : ElasticBody(mesh, order, std::vector<Material>(largest_attribute(mesh), material),
                 formulation)
{
}

ElasticBody::ElasticBody(mfem::Mesh &mesh, int order, const std::vector<Material> &materials,
                         Formulation formulation)
   : formulation_(formulation), materials_(materials)
{
   check_mesh(mesh);
   formulation_ = of_mesh(mesh, formulation);
   require_at_least("elastic body: element order", order, 1);
   ranks_ = Ranks(mesh);
   require(!materials_.empty(), "elastic body: there is no material, must be at least one");
   for (const Material &material : materials_)
   {
      material.validate();
      check_state(material.state, formulation_);
   }
   for (int attribute : mesh.attributes)
   {
      require(attribute >= 1 && attribute <= static_cast<int>(materials_.size()),
              "elastic body: element attribute ", attribute,
              " has no material: materials are given for attributes 1 to ", materials_.size());
   }
   const int attributes = largest_attribute(mesh);
   require(static_cast<int>(materials_.size()) <= attributes, "elastic body: there are ",
           materials_.size(), " materials, must be ", attributes,
           ", one for each element attribute");
   make_space(mesh, order);
   assemble();
}

ElasticBody::ElasticBody(mfem::Mesh &mesh, int order, Field young, Field poisson,
                         Formulation formulation, PlaneState state)
   : formulation_(formulation),
     varying_(VaryingMaterial{std::move(young), std::move(poisson), state})
{
   check_mesh(mesh);
   formulation_ = of_mesh(mesh, formulation);
   require_at_least("elastic body: element order", order, 1);
   ranks_ = Ranks(mesh);
   check_state(state, formulation_);
   make_space(mesh, order);
   assemble();
}

void ElasticBody::make_space(mfem::Mesh &mesh, int order)
{
   owned_collection_ = std::make_unique<mfem::H1_FECollection>(order, mesh.Dimension());
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
   check_mesh(*space.GetMesh());
   formulation_ = of_mesh(*space.GetMesh(), formulation);
   require(Ranks(*space.GetMesh()).size() == 1,
           "elastic body: the mesh is distributed, your operator on it must be a "
           "HypreParMatrix");
   check_space();
   require(stiffness.Finalized(),
           "elastic body: the stiffness is not finalized, call SparseMatrix::Finalize before");
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
   check_mesh(*space.GetMesh());
   formulation_ = of_mesh(*space.GetMesh(), formulation);
   ranks_ = Ranks(*space.GetMesh());
   check_space();
   const int size = space.GetTrueVSize();
   const bool fits = stiffness.Height() == size && stiffness.Width() == size;
   require(!ranks_.any(!fits), "elastic body: the stiffness on this rank is ",
           stiffness.Height(), "×", stiffness.Width(), ", must be ", size, "×", size,
           " (true dofs of the space) on each rank");
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
      // A true dof belongs to a node that depends on no others. Its row has one entry.
      const int *I = restriction->GetI(), *J = restriction->GetJ();
      for (int t = 0; t < restriction->Height(); ++t) { vdof_to_true_[J[I[t]]] = t; }
   }
   else
   {
      for (int v = 0; v < space.GetVSize(); ++v) { vdof_to_true_[v] = v; }
   }
   essential_.assign(space.GetTrueVSize(), false);

   const int dimension = mesh.Dimension();
   coordinates_.SetSize(dimension, space.GetNDofs());
   mfem::Array<int> dofs;
   mfem::DenseMatrix points;
   mfem::IsoparametricTransformation transformation;
   const bool vertices = !mesh.GetNodes() && space.GetNDofs() == mesh.GetNV();
   for (int v = 0; vertices && v < mesh.GetNV(); ++v)
   {
      for (int c = 0; c < dimension; ++c) { coordinates_(c, v) = mesh.GetVertex(v)[c]; }
   }
   for (int e = 0; !vertices && e < mesh.GetNE(); ++e)
   {
      space.GetElementDofs(e, dofs);
      mesh.GetElementTransformation(e, &transformation);
      transformation.Transform(space.GetFE(e)->GetNodes(), points);
      for (int i = 0; i < dofs.Size(); ++i)
      {
         for (int c = 0; c < dimension; ++c) { coordinates_(c, dofs[i]) = points(c, i); }
      }
   }
   for (int node = 0; node < space.GetNDofs(); ++node)
   {
      require(place(node).allFinite(), "elastic body: node ", node, " of the mesh is at ",
              place_text(place(node), formulation_), ", must be finite");
   }
   hold_axis();
}

void ElasticBody::hold_axis()
{
   if (!about_axis(formulation_)) { return; }
   // A node is on the axis if its radius is round-off of the largest coordinate.
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
         // u_r must vanish on the axis. A torsion body needs no support there: u_θ = r ψ
         // vanishes by itself.
         if (formulation_ == Formulation::axisymmetric && dof >= 0) { essential_[dof] = true; }
         continue;
      }
      require(coordinates_(0, node) > 0, "elastic body: node ", node,
              " of the mesh is at r = ", coordinates_(0, node), ", z = ", coordinates_(1, node),
              ", a body of revolution must have r >= 0");
   }
}

Eigen::AlignedBox3d ElasticBody::box() const
{
   Eigen::AlignedBox3d here;
   for (int node = 0; node < coordinates_.Width(); ++node) { here.extend(place(node)); }
   const double none = -std::numeric_limits<double>::infinity();
   Eigen::Matrix<double, 6, 1> sides = Eigen::Matrix<double, 6, 1>::Constant(none);
   if (!here.isEmpty()) { sides << -here.min(), here.max(); } // -low, high
   for (double &side : sides) { side = ranks_.max(side); }
   return {-sides.head<3>(), sides.tail<3>()};
}

Eigen::Vector3d ElasticBody::place(int scalar_dof) const
{
   return {coordinates_(0, scalar_dof), coordinates_(1, scalar_dof),
           coordinates_.Height() == 3 ? coordinates_(2, scalar_dof) : 0.0};
}

bool ElasticBody::on_axis(int scalar_dof) const
{
   return about_axis(formulation_) && std::abs(coordinates_(0, scalar_dof)) <= axis_radius_;
}

void ElasticBody::check_component(const std::string &where, int component) const
{
   require(component >= 0 && component < components(), where, ": component is ", component,
           ", must be ",
           formulation_ == Formulation::space          ? "0 (x), 1 (y) or 2 (z)"
           : formulation_ == Formulation::plane        ? "0 (x) or 1 (y)"
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
   const bool space = formulation_ == Formulation::space;
   bool turns = true; // does any of the part lie off the axis?
   for (int i : boundary_elements(mesh, part, where))
   {
      const double slack = interval_tolerance * (space ? BoundaryFace(mesh, i).size()
                                                       : BoundaryEdge(mesh, i).size());
      space_->GetBdrElementDofs(i, dofs);
      // u_θ = r ψ vanishes there by itself; the angle ψ does not.
      if (formulation_ == Formulation::torsion &&
          std::all_of(dofs.begin(), dofs.end(), [this](int node) { return on_axis(node); }))
      {
         turns = false;
         continue;
      }
      for (int node : dofs)
      {
         bool within = true;
         for (const BoundaryPart::Interval &one : part.intervals())
         {
            const double coordinate = coordinates_(one.axis, node);
            within = within && coordinate >= one.lo - slack && coordinate <= one.hi + slack;
         }
         if (within) { nodes.push_back(node); }
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
   require(ranks_.any(!nodes.empty() || !turns), where, ": no nodes lie on the ",
           describe(part));
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
   require(formulation_ != Formulation::space,
           "fix node: two coordinates are given, the body is in space, there must be three");
   fix_node_at({x, y, 0}, component);
}

void ElasticBody::fix_node(double x, double y, double z, int component)
{
   require(formulation_ == Formulation::space,
           "fix node: three coordinates are given, the body is ", name(formulation_),
           ", there must be two");
   fix_node_at({x, y, z}, component);
}

void ElasticBody::fix_node_at(const Eigen::Vector3d &point, int component)
{
   check_component("fix node", component);
   require(point.allFinite(), "fix node: the point is ", place_text(point, formulation_),
           ", must be finite");
   int nearest = -1;
   double distance = std::numeric_limits<double>::infinity();
   for (int node = 0; node < coordinates_.Width(); ++node)
   {
      if (true_dof(node, component) < 0) { continue; }
      const double d = (place(node) - point).norm();
      if (d < distance)
      {
         distance = d;
         nearest = node;
      }
   }
   // Several ranks may have a node at this distance. The first of them takes it.
   const std::vector<double> distances = ranks_.gather({distance});
   const auto first = std::min_element(distances.begin(), distances.end());
   const bool moves = formulation_ != Formulation::torsion || nearest < 0 || !on_axis(nearest);
   if (first - distances.begin() == ranks_.rank() && moves)
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

SharedMatrix ElasticBody::shared_stiffness() const
{
   return shared(stiffness_);
}

std::vector<int> ElasticBody::prescribed_dofs(const std::string &pattern) const
{
   std::vector<int> dofs;
   for (std::size_t k = 0; k < patterns_.size(); ++k)
   {
      if (patterns_[k].name != pattern) { continue; }
      for (std::size_t t = 0; t < prescribed_[k].size(); ++t)
      {
         if (prescribed_[k][t]) { dofs.push_back(static_cast<int>(t)); }
      }
   }
   return dofs;
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
           "elastic body: it has no material, because its stiffness was given as a matrix");
   require(
      !varying_,
      "elastic body: its material varies within an attribute: ask for the material at a point");
   require(attribute >= 1 && attribute <= static_cast<int>(materials_.size()),
           "elastic body: element attribute ", attribute,
           " has no material, must be from 1 to ", materials_.size());
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
