; A drive, nothing else: 1 action.
(define (problem to-cupboard)
  (:domain kitchen)
  (:objects dock cupboard - place)
  (:init (robot-at dock) (hand-empty) (arm-home))
  (:goal (robot-at cupboard)))
