#include <algorithm>
#include <cattaneo/contact/assemble.hpp>
#include <cattaneo/elastic/views.hpp>
#include <numeric>

namespace cattaneo
{

DofPlaces places_of(const ElasticBody &body)
{
   const mfem::DenseMatrix &x = body.node_coordinates();
   const int dofs = body.space().GetTrueVSize();
   DofPlaces places{Eigen::VectorXd::Zero(dofs), Eigen::VectorXd::Zero(dofs),
                    std::vector<int>(dofs, 0), body.formulation()};
   if (x.Height() == 3) { places.z = Eigen::VectorXd::Zero(dofs); }
   for (int node = 0; node < x.Width(); ++node)
   {
      for (int c = 0; c < body.components(); ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof < 0) { continue; }
         places.x[dof] = x(0, node);
         places.y[dof] = x(1, node);
         if (x.Height() == 3) { places.z[dof] = x(2, node); }
         places.component[dof] = c;
      }
   }
   return places;
}

namespace
{

#ifdef MFEM_USE_MPI

/// Rows of all ranks, one after the other, on the first.
std::shared_ptr<const mfem::SparseMatrix> gathered(const mfem::HypreParMatrix &K,
                                                   const Ranks &ranks)
{
   mfem::SparseMatrix own, others;
   HYPRE_BigInt *number;
   K.GetDiag(own);
   K.GetOffd(others, number);
   const auto first = static_cast<int>(K.ColPart()[0]);
   std::vector<int> length, column;
   std::vector<double> value;
   for (int i = 0; i < own.Height(); ++i)
   {
      length.push_back(own.RowSize(i) + others.RowSize(i));
      for (int k = 0; k < own.RowSize(i); ++k)
      {
         column.push_back(first + own.GetRowColumns(i)[k]);
         value.push_back(own.GetRowEntries(i)[k]);
      }
      for (int k = 0; k < others.RowSize(i); ++k)
      {
         column.push_back(static_cast<int>(number[others.GetRowColumns(i)[k]]));
         value.push_back(others.GetRowEntries(i)[k]);
      }
   }
   length = ranks.collect(length);
   column = ranks.collect(column);
   value = ranks.collect(value);
   if (!ranks.first()) { return nullptr; }
   const auto rows = static_cast<int>(length.size());
   // Arrays that the matrix will own.
   auto *I = new int[rows + 1], *J = new int[column.size()];
   auto *data = new double[value.size()];
   I[0] = 0;
   std::partial_sum(length.begin(), length.end(), I + 1);
   std::copy(column.begin(), column.end(), J);
   std::copy(value.begin(), value.end(), data);
   return std::make_shared<mfem::SparseMatrix>(I, J, data, rows, rows);
}

#endif

} // namespace

AssembledBody assembled(const ElasticBody &body)
{
   const mfem::Array<int> essential = body.essential_dofs();
   AssembledBody all{{},
                     {essential.begin(), essential.end()},
                     places_of(body),
                     body.patterns(),
                     !body.has_material(),
                     body.blocks()};
   const Ranks &ranks = body.ranks();
   if (!ranks.distributed()) { all.K = body.shared_stiffness(); }
#ifdef MFEM_USE_MPI
   if (!ranks.distributed()) { return all; }
   if (const auto K = gathered(*body.distributed_stiffness(), ranks)) { all.K = shared(K); }
   for (int &dof : all.fixed) { dof += body.first_global_dof(); }
   all.fixed = ranks.collect(all.fixed);
   const auto collect = [&ranks](Eigen::VectorXd &x)
   {
      const std::vector<double> values =
         ranks.collect(std::vector<double>(x.data(), x.data() + x.size()));
      x = Eigen::Map<const Eigen::VectorXd>(values.data(),
                                            static_cast<Eigen::Index>(values.size()));
   };
   collect(all.places.x);
   collect(all.places.y);
   all.places.component = ranks.collect(all.places.component);
   for (BodyLoad &load : all.loads) { collect(load.values); }
   for (BlockMotion &block : all.blocks) { collect(block.motion); }
#endif
   return all;
}

} // namespace cattaneo
