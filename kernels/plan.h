/* The numbers of a plan, which entry points take as one argument: a changed number compiles
 * nothing. Macros choose stages, planes, lanes, and what sizes memory: tiles, and the states of a
 * sensel. */

#define PF_CURVE_TERMS 7
#define PF_CURVE_LAST_POWER 6.0f

/* Coefficients of the polynomial of a response curve, lowest power first, and the scale of x,
 * 1/counts (pillar/curve.h). */
typedef struct {
  float terms[PF_CURVE_TERMS];
  float per_count;
  int root; /* t is the root of x */
} CurvePolynomial;

#define PF_MAX_PLAYS 4
#define PF_MAX_CREEPS 2

/* The inverse of SenselMemory: V = r + sum of weight * play with r = reading - sum of weight *
 * creep (pillar/memory.h). Unused weights are zero. */
typedef struct {
  float play_width[PF_MAX_PLAYS];
  float play_weight[PF_MAX_PLAYS];
  float creep_rate[PF_MAX_CREEPS];  /* part of the way to V in one frame */
  float creep_decay[PF_MAX_CREEPS]; /* frame interval over the time of the creep */
  float creep_weight[PF_MAX_CREEPS];
  int plays;
  int creeps;
} MemoryModel;

/* A number of C++ in one or two precisions is as precise; elsewhere it is single. */
#if defined(__cplusplus) && !defined(PF_LANES)
#define PF_PLAN_NUMBER Real
#else
#define PF_PLAN_NUMBER float
#endif
#define PF_MEMBER(name, needed, kind, value) PF_PLAN_NUMBER name;
typedef struct {
  PF_STAGE_CONSTANTS(PF_MEMBER)
  CurvePolynomial curve_polynomial;
  MemoryModel memory_model;
} PlanNumbers;
#undef PF_MEMBER
#undef PF_PLAN_NUMBER
