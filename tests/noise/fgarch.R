# ARMA-GARCH by fGarch: what r_arma_garch_test.cpp compares with.
#
#   Rscript fgarch.R SERIES D H P Q
#
# Prints the log-likelihood at the maximum that nlminb finds, and mu, alpha, beta, omega, gamma, delta there; then the standard
# deviations by the sandwich.
suppressMessages(library(fGarch))
arguments <- commandArgs(trailingOnly = TRUE)
y <- scan(arguments[1], quiet = TRUE)
orders <- as.integer(arguments[2:5])
model <- as.formula(sprintf("~arma(%d,%d)+garch(%d,%d)", orders[1], orders[2], orders[3], orders[4]))
# Its own choice of a Hessian, optimHess with steps of 1e-3, is an eighth off where omega is small; hessian = "rcd" is not.
found <- suppressWarnings(garchFit(model, data = y, cond.dist = "QMLE", init.rec = "mci", algorithm = "nlminb", hessian = "rcd",
                                   trace = FALSE))
cat(sprintf("%.17g", c(-found@fit$llh, found@fit$par, found@fit$se.coef)), "\n")
