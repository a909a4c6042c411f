#pragma once

#ifdef CATTANEO_USE_LAPACK
extern "C"
{
   void dgemm_(const char *, const char *, const int *, const int *, const int *,
               const double *, const double *, const int *, const double *, const int *,
               const double *, double *, const int *);
   void dpotrf_(const char *triangle, const int *n, double *A, const int *stride, int *info);
   void dpotrs_(const char *triangle, const int *n, const int *columns, const double *A,
                const int *stride, double *x, const int *x_stride, int *info);
   void dpotri_(const char *triangle, const int *n, double *A, const int *stride, int *info);
   void dtrsm_(const char *side, const char *triangle, const char *transposed,
               const char *diagonal, const int *rows, const int *columns, const double *factor,
               const double *A, const int *stride, double *x, const int *x_stride);
   void dtrsv_(const char *triangle, const char *transposed, const char *diagonal,
               const int *rows, const double *A, const int *stride, double *x,
               const int *x_step);
   void dsyrk_(const char *triangle, const char *transposed, const int *n, const int *inner,
               const double *factor, const double *A, const int *stride, const double *keep,
               double *C, const int *C_stride);
   void dsymv_(const char *triangle, const int *n, const double *factor, const double *A,
               const int *stride, const double *x, const int *x_step, const double *keep,
               double *y, const int *y_step);
   void ssymv_(const char *triangle, const int *n, const float *factor, const float *A,
               const int *stride, const float *x, const int *x_step, const float *keep,
               float *y, const int *y_step);
   void dgetrf_(const int *rows, const int *columns, double *A, const int *stride, int *pivots,
                int *info);
   void dgetrs_(const char *transposed, const int *n, const int *columns, const double *A,
                const int *stride, const int *pivots, double *x, const int *x_stride,
                int *info);
}
#endif
