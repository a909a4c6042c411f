// blas_kernels: the kernels that OpenBLAS uses here, for ./run, `cattaneo` and ./test
// --kernels.
//
//    blas_kernels           prints their name; nothing with another BLAS
//    blas_kernels --better  the name of far faster kernels for this processor, if there are any
//    blas_kernels --check   their name; exit code 1 if they do not multiply correctly
//
// It links nothing but LAPACK, and starts in milliseconds.

#include <cattaneo/algebra/blas_kernels.hpp>
#include <cattaneo/algebra/lapack.hpp>
#include <cstdio>
#include <cstring>
#include <vector>

namespace
{

#ifdef CATTANEO_USE_LAPACK

using Matrix = std::vector<double>; // column by column

/// Whole numbers, whose products and sums have no round-off.
Matrix whole_numbers(int rows, int columns)
{
   Matrix matrix;
   unsigned state = 12345;
   for (int k = 0; k < rows * columns; ++k)
   {
      state = 1664525u * state + 1013904223u;
      matrix.push_back(static_cast<int>(state >> 24) % 17 - 8);
   }
   return matrix;
}

/// Are products with X (inner × rows) those of plain loops, to the last bit?
bool multiplies_right(int rows, int columns, int inner)
{
   const double minus = -1, keep = 1;
   const Matrix X = whole_numbers(inner, rows), Y = whole_numbers(inner, columns);
   Matrix C = whole_numbers(rows, columns), S(rows * rows, 1.0);
   const auto product = [&](const Matrix &with, int i, int j)
   {
      double sum = 0;
      for (int k = 0; k < inner; ++k) { sum += X[i * inner + k] * with[j * inner + k]; }
      return sum;
   };
   const Matrix C_before = C;
   dgemm_("T", "N", &rows, &columns, &inner, &minus, X.data(), &inner, Y.data(), &inner, &keep,
          C.data(), &rows);
   dsyrk_("L", "T", &rows, &inner, &minus, X.data(), &inner, &keep, S.data(), &rows);
   bool right = true;
   for (int i = 0; i < rows; ++i)
   {
      for (int j = 0; j < columns; ++j)
      {
         const int at = j * rows + i;
         right = right && C[at] == C_before[at] - product(Y, i, j);
      }
      for (int j = 0; j < rows; ++j) // the lower triangle is made, the other one left
      {
         right = right && S[j * rows + i] == (i >= j ? 1 - product(X, i, j) : 1.0);
      }
   }
   return right;
}

bool multiply_right()
{
   for (const int rows : {1, 3, 8, 31, 64, 97})
   {
      for (const int columns : {1, 5, 16, 47, 130})
      {
         for (const int inner : {1, 4, 33, 200})
         {
            if (!multiplies_right(rows, columns, inner)) { return false; }
         }
      }
   }
   return true;
}

#else

bool multiply_right()
{
   return true;
}

#endif

} // namespace

int main(int argc, char *argv[])
{
   const cattaneo::BlasKernels kernels = cattaneo::blas_kernels();
   const char *asked = argc > 1 ? argv[1] : "";
   const bool better = std::strcmp(asked, "--better") == 0;
   std::printf("%s\n", better ? kernels.better.c_str() : kernels.name.c_str());
   return std::strcmp(asked, "--check") == 0 && !multiply_right() ? 1 : 0;
}
