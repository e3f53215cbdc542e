/* The learnt numbers that adaptive coefficients start from: the bytes of spec/priors.bin, which the build turns into C. */
#ifndef BSM_PRIORS_H
#define BSM_PRIORS_H

#define PRIORS_BYTES 12120

extern const unsigned char PRIORS[PRIORS_BYTES];

#endif
