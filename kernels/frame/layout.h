/* Memory layout of a frame, its calibration and its results: an argument of the entry points.
 * Calibration planes are [2 rows, plane_stride], result planes [rows, cols]; without pillars,
 * result planes are [sensel_rows, sensel_cols], and rows and cols count blocks of 2 x 2 sensels, of
 * which the last ones may lack a row or column. */
typedef struct {
  ulong row_stride; /* readings from one row of sensels to the next */
  ulong rows;       /* pillars */
  ulong cols;
  ulong sensel_rows;
  ulong sensel_cols;
  ulong plane_stride; /* sensels of a row of the calibration planes */
  ulong plane_bytes;  /* from one calibration plane to the next */
  ulong result_bytes; /* from one plane of results to the next */
  ulong status;       /* bytes from the first plane of results to the status bytes */
  ulong touched;      /* to the bytes that follow_baseline reads: the status of each pillar */
  ulong idle;         /* bytes from the first plane of results to the idle flags */
  ulong ring;         /* to the rings of neighbours.h */
  ulong wires;        /* to the vectors of find_wires.cl */
  ulong frame;        /* number of the frame, from 1 on */
  ulong forces;       /* to the planes of forces that correct_forces.cl reads */
  ulong ratios;       /* to the rows of find_shear_ratios */
} Layout;
