#include <cattaneo/algebra/sparse_factor.hpp>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cattaneo/algebra/lapack.hpp>
#include <cattaneo/algebra/one_thread.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cmath>
#include <numeric>

#ifdef CATTANEO_USE_CHOLMOD
#include <cholmod.h>
#if __has_include(<dlfcn.h>)
#include <dlfcn.h>
#endif
#endif

namespace cattaneo
{

namespace
{

/// The lower triangle of K(keep, keep) + shift, by columns (not sorted within a column). K is
/// symmetric, so its row i is its column i, and nothing has to be transposed.
struct LowerTriangle
{
   std::vector<int> start, row;
   std::vector<double> value;
   int size = 0, trailing = 0;

   LowerTriangle(const SparseView &K, const std::vector<int> &keep, int trailing_rows,
                 double shift)
      : size(static_cast<int>(keep.size())), trailing(trailing_rows)
   {
      std::vector<int> position(K.rows(), -1);
      for (int a = 0; a < size; ++a)
      {
         require(keep[a] >= 0 && keep[a] < K.rows(), "sparse factor: row ", keep[a],
                 " to keep, must be from 0 to ", K.rows() - 1);
         require(position[keep[a]] < 0, "sparse factor: row ", keep[a],
                 " is in the list of rows to keep twice, must be there once");
         position[keep[a]] = a;
      }
      start.resize(size + 1);
      const std::size_t estimate = (static_cast<std::size_t>(K.nonZeros()) + size) / 2;
      row.reserve(estimate + size);
      value.reserve(estimate + size);
      for (int a = 0; a < size; ++a)
      {
         start[a] = static_cast<int>(row.size());
         const double added = a >= size - trailing ? shift : 0.0;
         row.push_back(a);
         value.push_back(added);
         const std::size_t diagonal = value.size() - 1;
         for (SparseView::InnerIterator entry(K, keep[a]); entry; ++entry)
         {
            const int b = position[entry.col()];
            if (b < a) { continue; }
            require(std::isfinite(entry.value()), "sparse factor: entry (", keep[a], ", ",
                    entry.col(), ") of the matrix is ", entry.value(), ", must be finite");
            if (b == a)
            {
               value[diagonal] += entry.value();
               continue;
            }
            row.push_back(b);
            value.push_back(entry.value());
         }
      }
      start[size] = static_cast<int>(row.size());
   }
};

[[noreturn]] void not_positive_definite(int row)
{
   throw NotPositiveDefinite(row, "sparse factor: the matrix is not positive definite at row " +
                                     std::to_string(row) +
                                     ", it must be symmetric with positive eigenvalues");
}

/// L Lᵀ of a lower triangular L, in blocks, so that zeros above the diagonal are not
/// multiplied.
Eigen::MatrixXd times_own_transpose(const Eigen::MatrixXd &L)
{
   const Eigen::Index n = L.rows(), width = 96;
   const OneThread alone(std::pow(static_cast<double>(n), 3) / 3);
   Eigen::MatrixXd S(n, n);
   for (Eigen::Index j = 0; j < n; j += width)
   {
      const Eigen::Index w = std::min(width, n - j);
#ifdef CATTANEO_USE_LAPACK
      const int rows = static_cast<int>(n - j), columns = static_cast<int>(w),
                inner = static_cast<int>(j + w), stride = static_cast<int>(n);
      const double one = 1, zero = 0;
      dgemm_("N", "T", &rows, &columns, &inner, &one, L.data() + j, &stride, L.data() + j,
             &stride, &zero, &S(j, j), &stride);
#else
      S.block(j, j, n - j, w).noalias() =
         L.block(j, 0, n - j, j + w) * L.block(j, 0, w, j + w).transpose();
#endif
   }
   mirror_lower(S);
   return S;
}

} // namespace

struct SparseFactor::Implementation
{
   int size = 0, trailing = 0;
   double shift = 0.0;

   virtual ~Implementation() = default;
   /// L22.
   virtual Eigen::MatrixXd trailing_factor() const = 0;
   /// For each row of L22 the number that this row has among the trailing rows, 0 … trailing -
   /// 1.
   virtual std::vector<int> trailing_order() const = 0;
   /// L22 L22ᵀ x
   virtual Eigen::VectorXd trailing_product(const Eigen::VectorXd &x) const = 0;
   virtual Eigen::MatrixXd solve(const Eigen::MatrixXd &rhs) const = 0;
};

namespace
{

/// Column of L22, from the diagonal down.
struct TrailingColumn
{
   Eigen::Index column, count;
   const int *rows; ///< increasing, counted as those of L22 from `first`
   int first;
   const double *values;

   /// The entries of x in the rows of the column. In a dense column these are all from the
   /// diagonal down.
   template <class Visitor>
   void visit_rows(Visitor visit) const
   {
      for (Eigen::Index k = 0; k < count; ++k) { visit(rows[k] - first, values[k]); }
   }
   bool dense() const { return rows[count - 1] - rows[0] == count - 1; }
   Eigen::Map<const Eigen::VectorXd> entries() const { return {values, count}; }
   double dot(const Eigen::VectorXd &x) const
   {
      if (dense()) { return entries().dot(x.segment(rows[0] - first, count)); }
      double sum = 0;
      visit_rows([&](int row, double value) { sum += value * x[row]; });
      return sum;
   }
   void add_to(Eigen::VectorXd &y, double times) const
   {
      if (dense()) { y.segment(rows[0] - first, count) += times * entries(); }
      else
      {
         visit_rows([&](int row, double value) { y[row] += times * value; });
      }
   }
};

/// The functions of an implementation that only need to visit the columns of L22, by its
/// visit_trailing(visit).
template <class Factor>
struct ByColumns : SparseFactor::Implementation
{
   Eigen::MatrixXd trailing_factor() const override
   {
      Eigen::MatrixXd L22 = Eigen::MatrixXd::Zero(trailing, trailing);
      static_cast<const Factor *>(this)->visit_trailing(
         [&](const TrailingColumn &of)
         { of.visit_rows([&](int row, double value) { L22(row, of.column) = value; }); });
      return L22;
   }
   Eigen::VectorXd trailing_product(const Eigen::VectorXd &x) const override
   {
      Eigen::VectorXd half(x.size()), whole = Eigen::VectorXd::Zero(x.size());
      const auto *self = static_cast<const Factor *>(this);
      self->visit_trailing([&](const TrailingColumn &of) { half[of.column] = of.dot(x); });
      self->visit_trailing([&](const TrailingColumn &of)
                           { of.add_to(whole, half[of.column]); });
      return whole;
   }
};

/// Eigen's simplicial factor in the order AMD of the interior, then the trailing rows.
class EigenFactor : public ByColumns<EigenFactor>
{
   using Sparse = Eigen::SparseMatrix<double>;
   using Natural = Eigen::NaturalOrdering<int>;

   /// LDLᵀ that returns the place of its first pivot that is not positive.
   struct Diagnosis : Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Natural>
   {
      int first_bad(const Sparse &lower)
      {
         compute(lower);
         for (Eigen::Index i = 0; i < m_diag.size(); ++i)
         {
            if (!(m_diag[i] > 0)) { return static_cast<int>(i); }
         }
         return 0;
      }
   };

   Eigen::SimplicialLLT<Sparse, Eigen::Lower, Natural> llt_;
   std::vector<int> position_; ///< place in the factor of each row of keep

public:
   EigenFactor(const LowerTriangle &K, const std::vector<int> &keep)
   {
      const int n = K.size, interior = n - K.trailing;
      position_.resize(n);
      std::iota(position_.begin(), position_.end(), 0);
      if (interior > 0)
      {
         std::vector<Eigen::Triplet<double>> both;
         for (int a = 0; a < interior; ++a)
         {
            for (int k = K.start[a]; k < K.start[a + 1]; ++k)
            {
               if (K.row[k] >= interior) { continue; }
               both.emplace_back(K.row[k], a, 1.0);
               both.emplace_back(a, K.row[k], 1.0);
            }
         }
         Sparse pattern(interior, interior);
         pattern.setFromTriplets(both.begin(), both.end());
         Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
         Eigen::AMDOrdering<int>()(pattern, inverse);
         for (int k = 0; k < interior; ++k) { position_[inverse.indices()[k]] = k; }
      }
      std::vector<Eigen::Triplet<double>> entries;
      entries.reserve(K.row.size());
      for (int a = 0; a < n; ++a)
      {
         for (int k = K.start[a]; k < K.start[a + 1]; ++k)
         {
            const auto [low, high] = std::minmax(position_[a], position_[K.row[k]]);
            entries.emplace_back(high, low, K.value[k]);
         }
      }
      Sparse lower(n, n);
      lower.setFromTriplets(entries.begin(), entries.end());
      entries = {};
      llt_.compute(lower);
      if (llt_.info() != Eigen::Success)
      {
         const int bad = Diagnosis().first_bad(lower);
         const auto row =
            std::find(position_.begin(), position_.end(), bad) - position_.begin();
         not_positive_definite(keep[row]);
      }
   }

   std::vector<int> trailing_order() const override
   {
      std::vector<int> order(trailing);
      std::iota(order.begin(), order.end(), 0);
      return order;
   }
   template <class Visitor>
   void visit_trailing(Visitor visit) const
   {
      const int interior = size - trailing;
      const Sparse &L = llt_.matrixL().nestedExpression();
      for (int c = 0; c < trailing; ++c)
      {
         const int first = L.outerIndexPtr()[interior + c],
                   end = L.outerIndexPtr()[interior + c + 1];
         visit(TrailingColumn{c, end - first, L.innerIndexPtr() + first, interior,
                              L.valuePtr() + first});
      }
   }

   Eigen::MatrixXd solve(const Eigen::MatrixXd &rhs) const override
   {
      Eigen::MatrixXd b(rhs.rows(), rhs.cols()), x(rhs.rows(), rhs.cols());
      for (int a = 0; a < size; ++a) { b.row(position_[a]) = rhs.row(a); }
      b = llt_.solve(b).eval();
      for (int a = 0; a < size; ++a) { x.row(a) = b.row(position_[a]); }
      return x;
   }
};

#ifdef CATTANEO_USE_CHOLMOD

/** While it lives, OpenMP regions of the libraries we call run on one thread. CHOLMOD asks for
    four threads at several small loops of every supernode, whatever OMP_NUM_THREADS says;
    waking them takes as long as the factorisation itself (17,000 dofs: 50 ms instead of 26 ms;
    260,000: 1.5 s instead of 1.1 s). The parallel part that pays is in BLAS, and stays
    parallel. Only at run time is it known whether there is an OpenMP library. */
class OneOpenMPThread
{
   using Get = int (*)();
   using Set = void (*)(int);
   Set set_ = nullptr;
   int levels_ = 0;

public:
   OneOpenMPThread()
   {
#if __has_include(<dlfcn.h>)
      const auto get = reinterpret_cast<Get>(dlsym(RTLD_DEFAULT, "omp_get_max_active_levels"));
      set_ = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"));
      if (!get || !set_)
      {
         set_ = nullptr;
         return;
      }
      levels_ = get();
      set_(0);
#endif
   }
   ~OneOpenMPThread()
   {
      if (set_) { set_(levels_); }
   }
   OneOpenMPThread(const OneOpenMPThread &) = delete;
   OneOpenMPThread &operator=(const OneOpenMPThread &) = delete;
};

/// CHOLMOD's supernodal factor in a constrained minimum degree order (CAMD), or by nested
/// dissection (METIS).
class CholmodFactor : public ByColumns<CholmodFactor>
{
   mutable cholmod_common common_; // CHOLMOD's workspace: solves write to it
   cholmod_factor *L_ = nullptr;

   void check(bool done, const char *step)
   {
      if (done && common_.status >= 0) { return; }
      const int status = common_.status;
      release();
      if (status == CHOLMOD_OUT_OF_MEMORY) { throw std::bad_alloc(); }
      throw std::runtime_error(std::string("sparse factor: CHOLMOD failed to ") + step +
                               " (status " + std::to_string(status) + ")");
   }

   void release()
   {
      cholmod_free_factor(&L_, &common_);
      cholmod_finish(&common_);
   }

   /// The interior rows by nested dissection of the graph of their nodes, then the trailing
   /// ones. False if CHOLMOD has no METIS, or METIS fails.
   bool dissect(const LowerTriangle &K, const std::vector<int> &nodes, std::vector<int> &order)
   {
      // Only at run time is it known whether CHOLMOD was built with METIS.
      decltype(&cholmod_metis) metis = nullptr;
#if __has_include(<dlfcn.h>)
      metis = reinterpret_cast<decltype(&cholmod_metis)>(dlsym(RTLD_DEFAULT, "cholmod_metis"));
#endif
      if (!metis) { return false; }
      const int interior = K.size - K.trailing;
      std::vector<int> numbers(nodes.begin(), nodes.begin() + interior);
      std::sort(numbers.begin(), numbers.end());
      numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
      const auto count = static_cast<int>(numbers.size());
      std::vector<int> node(interior);
      std::vector<std::vector<int>> rows(count), linked(count);
      for (int a = 0; a < interior; ++a)
      {
         node[a] = static_cast<int>(std::lower_bound(numbers.begin(), numbers.end(), nodes[a]) -
                                    numbers.begin());
         rows[node[a]].push_back(a);
      }
      // Columns of the graph's lower triangle, each link once.
      for (int a = 0; a < interior; ++a)
      {
         for (int k = K.start[a]; k < K.start[a + 1]; ++k)
         {
            if (K.row[k] >= interior) { continue; }
            const auto [low, high] = std::minmax(node[a], node[K.row[k]]);
            linked[low].push_back(high);
         }
      }
      std::vector<int> start{0}, row;
      for (std::vector<int> &its : linked)
      {
         std::sort(its.begin(), its.end());
         its.erase(std::unique(its.begin(), its.end()), its.end());
         row.insert(row.end(), its.begin(), its.end());
         start.push_back(static_cast<int>(row.size()));
      }
      cholmod_sparse graph = {};
      graph.nrow = graph.ncol = count;
      graph.nzmax = row.size();
      graph.p = start.data();
      graph.i = row.data();
      graph.stype = -1;
      graph.itype = CHOLMOD_INT;
      graph.xtype = CHOLMOD_PATTERN;
      graph.dtype = CHOLMOD_DOUBLE;
      graph.sorted = 1;
      graph.packed = 1;
      std::vector<int> by_node(count);
      if (count == 0 || !metis(&graph, nullptr, 0, 0, by_node.data(), &common_))
      {
         common_.status = CHOLMOD_OK;
         return false;
      }
      order.clear();
      for (int k : by_node) { order.insert(order.end(), rows[k].begin(), rows[k].end()); }
      for (int a = interior; a < K.size; ++a) { order.push_back(a); }
      return true;
   }

public:
   CholmodFactor(LowerTriangle &K, const std::vector<int> &keep, const std::vector<int> &nodes)
   {
      const OneOpenMPThread one_thread;
      cholmod_start(&common_);
      common_.print = 0;
      // The analysis must use the given order. Other methods are switched off, and so is the
      // postorder, which may move the trailing rows.
      common_.nmethods = 1;
      common_.method[0].ordering = CHOLMOD_GIVEN;
      common_.postorder = 0;
      common_.supernodal = CHOLMOD_SUPERNODAL;
      common_.final_ll = 1;
      common_.quick_return_if_not_posdef = 1;

      cholmod_sparse A = {};
      A.nrow = A.ncol = K.size;
      A.nzmax = K.row.size();
      A.p = K.start.data();
      A.i = K.row.data();
      A.x = K.value.data();
      A.stype = -1;
      A.itype = CHOLMOD_INT;
      A.xtype = CHOLMOD_REAL;
      A.dtype = CHOLMOD_DOUBLE;
      A.packed = 1;

      std::vector<int> order(K.size);
      if (nodes.empty() || !dissect(K, nodes, order))
      {
         std::vector<int> group(K.size, 0);
         std::fill(group.end() - K.trailing, group.end(), 1);
         order.resize(K.size);
         check(cholmod_camd(&A, nullptr, 0, group.data(), order.data(), &common_),
               "order the matrix");
      }
      L_ = cholmod_analyze_p(&A, order.data(), nullptr, 0, &common_);
      check(L_ != nullptr, "analyse the matrix");
      // CHOLMOD counts two operations for each multiplication. Most fronts are small, so only a
      // share of the work gains from threads.
      constexpr double share_of_large_fronts = 0.2;
      const OneThread alone(share_of_large_fronts * 0.5 * common_.fl);
      check(cholmod_factorize(&A, L_, &common_), "factor the matrix");
      if (L_->minor < L_->n)
      {
         const int row = keep[static_cast<const int *>(L_->Perm)[L_->minor]];
         release();
         not_positive_definite(row);
      }
   }

   ~CholmodFactor() override
   {
      release();
   }
   CholmodFactor(const CholmodFactor &) = delete;
   CholmodFactor &operator=(const CholmodFactor &) = delete;

   std::vector<int> trailing_order() const override
   {
      const auto *permutation = static_cast<const int *>(L_->Perm);
      const int interior = size - trailing;
      std::vector<int> order(trailing);
      for (int k = 0; k < trailing; ++k) { order[k] = permutation[interior + k] - interior; }
      if (trailing > 0 && *std::min_element(order.begin(), order.end()) < 0)
      {
         throw std::logic_error("sparse factor: the trailing rows were not ordered last");
      }
      return order;
   }
   template <class Visitor>
   void visit_trailing(Visitor visit) const
   {
      const auto *super = static_cast<const int *>(L_->super);
      const auto *pi = static_cast<const int *>(L_->pi);
      const auto *px = static_cast<const int *>(L_->px);
      const auto *s = static_cast<const int *>(L_->s);
      const auto *x = static_cast<const double *>(L_->x);
      const int interior = size - trailing;
      for (int k = static_cast<int>(L_->nsuper) - 1; k >= 0 && super[k + 1] > interior; --k)
      {
         const int rows = pi[k + 1] - pi[k];
         // A relaxed supernode may begin before the first trailing column. Entries above the
         // diagonal are stored but are not part of L.
         for (int c = std::max(super[k], interior); c < super[k + 1]; ++c)
         {
            const double *column = x + px[k] + static_cast<std::ptrdiff_t>(c - super[k]) * rows;
            const int diagonal = c - super[k];
            visit(TrailingColumn{c - interior, rows - diagonal, s + pi[k] + diagonal, interior,
                                 column + diagonal});
         }
      }
   }

   Eigen::MatrixXd solve(const Eigen::MatrixXd &rhs) const override
   {
      const OneOpenMPThread one_thread;
      const OneThread alone(OneThread::reads_once * common_.lnz);
      cholmod_dense b = {};
      b.nrow = rhs.rows();
      b.ncol = rhs.cols();
      b.nzmax = rhs.size();
      b.d = rhs.rows();
      b.x = const_cast<double *>(rhs.data()); // not written to
      b.xtype = CHOLMOD_REAL;
      b.dtype = CHOLMOD_DOUBLE;
      cholmod_dense *x = cholmod_solve(CHOLMOD_A, L_, &b, &common_);
      if (!x) { throw std::bad_alloc(); }
      Eigen::MatrixXd result =
         Eigen::Map<const Eigen::MatrixXd>(static_cast<double *>(x->x), rhs.rows(), rhs.cols());
      cholmod_free_dense(&x, &common_);
      return result;
   }
};

#endif

} // namespace

SparseFactor::SparseFactor(const SparseView &K, const std::vector<int> &keep, int trailing,
                           double shift, [[maybe_unused]] Backend backend,
                           const std::vector<int> &nodes)
{
   require(K.rows() == K.cols(), "sparse factor: the matrix (", K.rows(), "×", K.cols(),
           ") must be square");
   require(!keep.empty(), "sparse factor: there are no rows to factor");
   require(trailing >= 0 && trailing <= static_cast<int>(keep.size()),
           "sparse factor: ", trailing, " trailing rows, must be from 0 to ", keep.size());
   require(std::isfinite(shift) && shift >= 0, "sparse factor: shift is ", shift,
           ", must be finite and not negative");
   require(nodes.empty() || nodes.size() == keep.size(), "sparse factor: nodes are given for ",
           nodes.size(), " rows, must be given for all ", keep.size(), " or for none");
   LowerTriangle lower(K, keep, trailing, shift);
#ifdef CATTANEO_USE_CHOLMOD
   if (backend == Backend::automatic)
   {
      impl_ = std::make_unique<CholmodFactor>(lower, keep, nodes);
   }
#endif
   if (!impl_) { impl_ = std::make_unique<EigenFactor>(lower, keep); }
   impl_->size = lower.size;
   impl_->trailing = trailing;
   impl_->shift = shift;
}

SparseFactor::~SparseFactor() = default;

Eigen::MatrixXd SparseFactor::schur() const
{
   const std::vector<int> order = impl_->trailing_order();
   const Eigen::MatrixXd permuted = times_own_transpose(impl_->trailing_factor());
   Eigen::MatrixXd S(permuted.rows(), permuted.cols());
   for (Eigen::Index j = 0; j < S.cols(); ++j)
   {
      double *column = S.data() + order[j] * S.rows();
      for (Eigen::Index i = 0; i < S.rows(); ++i) { column[order[i]] = permuted(i, j); }
   }
   S.diagonal().array() -= impl_->shift;
   return S;
}

Eigen::MatrixXd SparseFactor::push(const Eigen::MatrixXd &x) const
{
   const std::vector<int> order = impl_->trailing_order();
   Eigen::MatrixXd forces(x.rows(), x.cols());
   for (Eigen::Index k = 0; k < x.cols(); ++k)
   {
      forces(order, k) = impl_->trailing_product(x(order, k));
   }
   return forces;
}

Eigen::MatrixXd SparseFactor::solve(const Eigen::MatrixXd &rhs) const
{
   require(rhs.rows() == rows(), "sparse factor: right-hand sides have ", rhs.rows(),
           " rows, must have as many as the factor, ", rows());
   return impl_->solve(rhs);
}

int SparseFactor::rows() const
{
   return impl_->size;
}

} // namespace cattaneo
