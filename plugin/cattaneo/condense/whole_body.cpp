#include <algorithm>
#include <cattaneo/condense/whole_body.hpp>
#include <numeric>

namespace cattaneo
{

namespace
{

DofPlaces places_of(const ElasticBody &body)
{
   const mfem::DenseMatrix &x = body.node_coordinates();
   const int dofs = body.space().GetTrueVSize();
   DofPlaces places{Eigen::VectorXd::Zero(dofs), Eigen::VectorXd::Zero(dofs),
                    std::vector<int>(dofs, 0), body.geometry()};
   for (int node = 0; node < x.Width(); ++node)
   {
      for (int c = 0; c < body.components(); ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof < 0) { continue; }
         places.x[dof] = x(0, node);
         places.y[dof] = x(1, node);
         places.component[dof] = c;
      }
   }
   return places;
}

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
   // For the matrix to own.
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

WholeBody whole(const ElasticBody &body)
{
   const mfem::Array<int> essential = body.essential_dofs();
   WholeBody all{body.shared_stiffness(),
                 {essential.begin(), essential.end()},
                 places_of(body),
                 body.patterns()};
#ifdef MFEM_USE_MPI
   const Ranks &ranks = body.ranks();
   if (!ranks.distributed()) { return all; }
   all.K = gathered(*body.distributed_stiffness(), ranks);
   for (int &dof : all.essential) { dof += body.first_global_dof(); }
   all.essential = ranks.collect(all.essential);
   const auto collect = [&ranks](const double *values, int count)
   { return ranks.collect(std::vector<double>(values, values + count)); };
   for (Eigen::VectorXd *x : {&all.places.x, &all.places.y})
   {
      const std::vector<double> values = collect(x->data(), static_cast<int>(x->size()));
      *x = Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
   }
   all.places.component = ranks.collect(all.places.component);
   for (ElasticBody::Pattern &pattern : all.patterns)
   {
      const std::vector<double> values =
         collect(pattern.values.GetData(), pattern.values.Size());
      pattern.values.SetSize(static_cast<int>(values.size()));
      std::copy(values.begin(), values.end(), pattern.values.GetData());
   }
#endif
   return all;
}

} // namespace cattaneo
