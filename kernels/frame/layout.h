/* Where a frame and what belongs to it lie in memory: an argument of the entry points, which the
 * host fills in. Calibration planes are [sensel rows, plane_stride] each, result planes [rows,
 * cols] each, one plane so many bytes after the other. */
typedef struct {
  ulong row_stride; /* readings from one row of sensels to the next */
  ulong rows;       /* pillars */
  ulong cols;
  ulong plane_stride; /* sensels of a row of the calibration planes */
  ulong plane_bytes;  /* from one calibration plane to the next */
  ulong result_bytes; /* from one plane of results to the next */
  ulong status;       /* bytes from the first plane of results to the status bytes */
  ulong idle;         /* and to the marks of idle blocks */
} Layout;
