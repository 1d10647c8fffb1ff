"""The paper's two stages as an estimator: start, joint solve, covariances."""
